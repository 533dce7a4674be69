#include "drivers/datasets/dataset_sources.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <tuple>
#include <vector>

#include "drivers/datasets/bop_dataset.hpp"
#include "drivers/files/frame_folder.hpp"
#include "drivers/files/image_file.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"

namespace houghstream {
namespace {

class BopSource : public FrameSource {
 public:
  explicit BopSource(const std::filesystem::path& folder) : scene_(folder) {}

  std::optional<RgbdFrame> next() override {
    if (index_ == scene_.images().size()) return std::nullopt;
    return scene_.read_frame(index_++);
  }

  double rate_hz() const override { return kDatasetRateHz; }

 private:
  BopScene scene_;
  std::size_t index_ = 0;
};

class UwSource : public FrameSource {
 public:
  UwSource(const std::filesystem::path& folder, const Camera& camera)
      : pairs_(list_frame_pairs(folder)), camera_(camera) {}

  std::optional<RgbdFrame> next() override {
    if (index_ == pairs_.size()) return std::nullopt;
    const std::size_t index = index_++;
    return read_frame_pair(pairs_[index], camera_, dataset_utime(index));
  }

  double rate_hz() const override { return kDatasetRateHz; }

 private:
  std::vector<FrameFiles> pairs_;
  Camera camera_;
  std::size_t index_ = 0;
};

namespace fs = std::filesystem;

struct TimedImage {
  std::int64_t utime = 0;
  fs::path file;
};

struct TumPair {
  TimedImage colour;
  TimedImage depth;
};

std::vector<TimedImage> read_list(const fs::path& folder, const char* name) {
  const fs::path file = folder / name;
  std::istringstream in(read_file(file, "a list of images"));
  require(in.good(), "{}: cannot be read, expected the image list of a TUM sequence", file.string());
  std::vector<TimedImage> images;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (line.empty() || line.front() == '#') continue;
    std::istringstream words(line);
    double time_s = 0.0;
    std::string path;
    require(static_cast<bool>(words >> time_s >> path) && std::isfinite(time_s) && std::abs(time_s) < 1e11,
            "{} line {}: '{}', expected SECONDS FILE", file.string(), number, line.substr(0, 80));
    images.push_back({std::llround(time_s * 1e6), folder / path});
  }
  require(!images.empty(), "{}: no images", file.string());
  std::sort(images.begin(), images.end(), [](const auto& a, const auto& b) { return a.utime < b.utime; });
  return images;
}

std::vector<TumPair> pair_images(const fs::path& folder, const std::vector<TimedImage>& colours,
                                 const std::vector<TimedImage>& depths) {
  constexpr std::int64_t kMaxDistance_us = 20000;
  constexpr std::size_t kMaxNear = 64;  // colour images near one depth image: all of them are compared
  std::vector<std::tuple<std::int64_t, std::size_t, std::size_t>> candidates;  // distance, depth, colour
  std::size_t first = 0;
  for (std::size_t d = 0; d < depths.size(); ++d) {
    while (first < colours.size() && colours[first].utime < depths[d].utime - kMaxDistance_us) ++first;
    for (std::size_t c = first; c < colours.size() && colours[c].utime <= depths[d].utime + kMaxDistance_us; ++c) {
      require(c - first < kMaxNear, "{}: more than {} colour images within 20 ms of {}, expected a sequence",
              (folder / "rgb.txt").string(), kMaxNear, depths[d].file.string());
      candidates.emplace_back(std::abs(colours[c].utime - depths[d].utime), d, c);
    }
  }
  std::sort(candidates.begin(), candidates.end());
  std::vector<bool> colour_used(colours.size());
  std::vector<bool> depth_used(depths.size());
  std::vector<TumPair> pairs;
  for (const auto& [distance, d, c] : candidates) {
    if (colour_used[c] || depth_used[d]) continue;
    colour_used[c] = depth_used[d] = true;
    pairs.push_back({colours[c], depths[d]});
  }
  std::sort(pairs.begin(), pairs.end(), [](const auto& a, const auto& b) { return a.depth.utime < b.depth.utime; });
  return pairs;
}

class TumSource : public FrameSource {
 public:
  TumSource(const fs::path& folder, const Camera& camera)
      : pairs_(pair_images(folder, read_list(folder, "rgb.txt"), read_list(folder, "depth.txt"))), camera_(camera) {
    require(!pairs_.empty(), "{}: no colour image within 20 ms of a depth image", folder.string());
  }

  std::optional<RgbdFrame> next() override {
    if (index_ == pairs_.size()) return std::nullopt;
    const TumPair& pair = pairs_[index_++];
    constexpr double kMillimetresPerStep = 0.2;
    RgbdFrame frame;
    frame.id.utime = pair.depth.utime;
    frame.camera = camera_;
    frame.colour = read_colour_image(pair.colour.file);
    frame.depth = depth_from_millimetres(read_depth_image(pair.depth.file)) * kMillimetresPerStep;
    check_frame(frame, pair.depth.file.string());
    return frame;
  }

  double rate_hz() const override { return kDatasetRateHz; }

 private:
  std::vector<TumPair> pairs_;
  Camera camera_;
  std::size_t index_ = 0;
};

}  // namespace

std::unique_ptr<FrameSource> open_bop_source(const std::filesystem::path& folder) {
  return std::make_unique<BopSource>(folder);
}

std::unique_ptr<FrameSource> open_uw_source(const std::filesystem::path& folder, const Camera& camera) {
  return std::make_unique<UwSource>(folder, camera);
}

std::unique_ptr<FrameSource> open_tum_source(const fs::path& folder, const Camera& camera) {
  return std::make_unique<TumSource>(folder, camera);
}

}  // namespace houghstream
