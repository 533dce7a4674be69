#include "drivers/openni/recording/recorded_start.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace houghstream::openni {
namespace {

constexpr int kStep = 8;

/// How well what is recorded fits what was seen at the same times, if the recording begins at `start_us`.
RecordedStart start_at(std::int64_t start_us, const std::vector<Remembered>& recorded,
                       const std::vector<Remembered>& live) {
  RecordedStart start{start_us, 0.0, 0};
  for (const Remembered& image : recorded) {
    const auto same_time = std::find_if(live.begin(), live.end(), [&](const Remembered& other) {
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

bool fits_better(const RecordedStart& a, const RecordedStart& b) {
  return a.difference < b.difference || (a.difference == b.difference && a.images > b.images);
}

}  // namespace

Remembered remember(const SensorImage& image) {
  Remembered small{static_cast<std::int64_t>(image.device_us), {}};
  cv::resize(image.image, small.some_pixels, {}, 1.0 / kStep, 1.0 / kStep, cv::INTER_NEAREST);
  return small;
}

std::optional<RecordedStart> find_recorded_start(const std::vector<Remembered>& recorded,
                                                 const std::vector<Remembered>& live) {
  std::vector<std::int64_t> starts;
  for (const Remembered& seen : live) {
    for (const Remembered& image : recorded) starts.push_back(seen.time_us - image.time_us);
  }
  std::sort(starts.begin(), starts.end());
  starts.erase(std::unique(starts.begin(), starts.end()), starts.end());
  std::optional<RecordedStart> best;
  for (const std::int64_t start_us : starts) {
    const RecordedStart start = start_at(start_us, recorded, live);
    if (start.images > 0 && 2 * start.images >= recorded.size() && (!best || fits_better(start, *best))) best = start;
  }
  return best;
}

}  // namespace houghstream::openni
