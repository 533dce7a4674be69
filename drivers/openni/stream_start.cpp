#include "drivers/openni/stream_start.hpp"

#include <algorithm>
#include <cstdlib>
#include <opencv2/imgproc.hpp>
#include <tuple>

namespace houghstream::openni {
namespace {

constexpr int kStep = 8;
constexpr std::size_t kMin = 4;                // minimum number of images that identify a position
constexpr std::int64_t kMaxApartUs = 500'000;  // one recorder starts both streams

/// Returns how well the recorded images match the observed thumbnails of the same times, if the recording begins at
/// `start_us`.
StreamStart start_at(std::int64_t start_us, const std::vector<ImageThumbnail>& recorded,
                     const std::vector<ImageThumbnail>& live) {
  StreamStart start{start_us, 0.0, 0};
  for (const ImageThumbnail& image : recorded) {
    const auto same_time = std::find_if(live.begin(), live.end(), [&](const ImageThumbnail& other) {
      return other.time_us == start_us + image.time_us && other.some_pixels.size() == image.some_pixels.size();
    });
    if (same_time == live.end()) continue;
    const auto values = static_cast<double>(image.some_pixels.total() * image.some_pixels.channels());
    start.difference += cv::norm(image.some_pixels, same_time->some_pixels, cv::NORM_L1) / values;
    ++start.images;
  }
  if (start.images > 0) start.difference /= static_cast<double>(start.images);
  return start;
}

/// The places where enough was seen, the earliest first.
std::vector<StreamStart> possible_starts(const std::vector<ImageThumbnail>& recorded,
                                         const std::vector<ImageThumbnail>& live) {
  std::vector<std::int64_t> starts;
  for (const ImageThumbnail& seen : live) {
    for (const ImageThumbnail& image : recorded) starts.push_back(seen.time_us - image.time_us);
  }
  std::sort(starts.begin(), starts.end());
  starts.erase(std::unique(starts.begin(), starts.end()), starts.end());
  const std::size_t min_count = std::min(kMin, (recorded.size() + 1) / 2);
  std::vector<StreamStart> possible;
  for (const std::int64_t start_us : starts) {
    const StreamStart start = start_at(start_us, recorded, live);
    if (start.images >= min_count) possible.push_back(start);
  }
  return possible;
}

std::int64_t apart_us(const RecordedStarts& starts) {
  return std::abs(starts.colour.device_us - starts.depth.device_us);
}

bool fits_better(const RecordedStarts& a, const RecordedStarts& b) {
  const auto key = [](const RecordedStarts& starts) {
    const auto images = static_cast<std::int64_t>(starts.depth.images + starts.colour.images);
    return std::make_tuple(starts.depth.difference + starts.colour.difference, -images, apart_us(starts));
  };
  return key(a) < key(b);
}

}  // namespace

ImageThumbnail make_thumbnail(const SensorImage& image) {
  ImageThumbnail small{static_cast<std::int64_t>(image.device_us), {}};
  cv::resize(image.image, small.some_pixels, {}, 1.0 / kStep, 1.0 / kStep, cv::INTER_NEAREST);
  return small;
}

std::optional<RecordedStarts> find_stream_starts(const FirstImages& recorded, const FirstImages& live) {
  const std::vector<StreamStart> of_colour = possible_starts(recorded.colour, live.colour);
  std::optional<RecordedStarts> best;
  for (const StreamStart& depth : possible_starts(recorded.depth, live.depth)) {
    for (const StreamStart& colour : of_colour) {
      const RecordedStarts starts{depth, colour};
      if (apart_us(starts) <= kMaxApartUs && (!best || fits_better(starts, *best))) best = starts;
    }
  }
  return best;
}

}  // namespace houghstream::openni
