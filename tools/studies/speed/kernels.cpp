#include "tools/studies/speed/kernels.hpp"

#include <benchmark/benchmark.h>

#include "detector/features/features.hpp"
#include "detector/forest/seen_patches.hpp"
#include "detector/voting/hypotheses.hpp"
#include "detector/voting/voting.hpp"
#include "pipeline/messages/codecs.hpp"

namespace houghstream {
namespace {

template <typename Kernel>
void add(const char* name, const Kernel& kernel) {
  benchmark::RegisterBenchmark(name, [kernel](benchmark::State& state) {
    for (auto _ : state) kernel();
  })->Unit(benchmark::kMillisecond);
}

void register_codecs(const RgbdFrame& frame) {
  constexpr int kQuality = 94;  // hs-capture's defaults
  constexpr int kZipLevel = 1;
  const cv::Size size = frame.colour.size();
  add("jpeg", [jpeg = encode_jpeg(frame.colour, kQuality), size] {
    benchmark::DoNotOptimize(decode_jpeg({jpeg.data(), jpeg.size()}, size.width, size.height));
  });
  add("unzip", [zipped = zip_depth(depth_to_millimetres(frame.depth), kZipLevel), size] {
    benchmark::DoNotOptimize(
        depth_from_millimetres(unzip_depth({zipped.data(), zipped.size()}, size.width, size.height)));
  });
}

/// Each level of the working frame, all of it.
void register_features(const RgbdFrame& frame, const Forest& forest) {
  add("working_frame", [&frame, &forest] {
    for (const FeatureLevel& level : feature_levels(forest.features)) {
      benchmark::DoNotOptimize(make_working_frame(frame, level, forest.features));
    }
  });
  std::vector<WorkingFrame> working;
  for (const FeatureLevel& level : feature_levels(forest.features)) {
    working.push_back(make_working_frame(frame, level, forest.features));
  }
  add("features", [working, &forest] {
    for (const WorkingFrame& view : working) benchmark::DoNotOptimize(compute_features(view, forest.features, 1));
  });
}

void register_search(const RgbdFrame& frame, const Forest& forest, const DetectionSettings& settings) {
  add("resize_features_forest", [&frame, &forest, &settings] {
    static SeenPatches seen;  // its memory is kept, as the detector's is
    StageClock clock;
    classify_patches(forest, frame, settings, clock, seen);
  });
  static SeenPatches seen;
  StageClock clock;
  classify_patches(forest, frame, settings, clock, seen);
  add("votes", [&forest, &settings] {
    static HoughSpace space;
    for (std::size_t c = 0; c < forest.classes.size(); ++c) {
      cast_votes(forest, static_cast<int>(c), seen.grid, seen.beliefs, seen.hough_camera, settings, space);
    }
  });
  static std::vector<HoughSpace> spaces(forest.classes.size());
  for (std::size_t c = 0; c < spaces.size(); ++c) {
    cast_votes(forest, static_cast<int>(c), seen.grid, seen.beliefs, seen.hough_camera, settings, spaces[c]);
  }
  add("hypotheses", [&forest, &settings] {
    for (std::size_t c = 0; c < spaces.size(); ++c) {
      const float least = settings.min_mass_share * forest.classes[c].expected_mass;
      benchmark::DoNotOptimize(find_hypotheses(forest, spaces[c], seen.grid, seen.hough_camera, least, settings));
    }
  });
}

}  // namespace

void register_kernels(const RgbdFrame& frame, const Forest& forest, const DetectionSettings& settings) {
  register_codecs(frame);
  register_features(frame, forest);
  register_search(frame, forest, settings);
}

}  // namespace houghstream
