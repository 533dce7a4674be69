#include "tools/studies/speed/kernels.hpp"

#include <benchmark/benchmark.h>

#include "detector/stages.hpp"
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

/// Registers each level of the working frame, all of it.
void register_features(const RgbdFrame& frame, const Forest& forest) {
  add("working_frame", [&frame, &forest] {
    for (const FeatureLevel& level : feature_levels(forest.features, frame.camera)) {
      benchmark::DoNotOptimize(make_working_frame(frame, level, forest.features));
    }
  });
  std::vector<WorkingFrame> working;
  for (const FeatureLevel& level : feature_levels(forest.features, frame.camera)) {
    working.push_back(make_working_frame(frame, level, forest.features));
  }
  add("features", [working, &forest] {
    for (const WorkingFrame& view : working) benchmark::DoNotOptimize(compute_features(view, forest.features, 1));
  });
}

/// Runs the stages of Detector::detect from the images to the leaves.
void see(const SearchContext& search, const RgbdFrame& frame, DetectorWorkspace& workspace) {
  make_working_images(search, frame, workspace);
  compute_features(search, workspace);
  find_posteriors(search, workspace);
}

void register_search(const RgbdFrame& frame, const ForestIndex& index, const DetectionSettings& settings) {
  static DetectorWorkspace workspace;  // kept from call to call, as the detector's is
  add("resize_features_leaves", [&frame, &index, &settings] { see({index, settings}, frame, workspace); });
  static DetectorWorkspace seen;
  see({index, settings}, frame, seen);
  add("votes", [&index, &settings] {
    static VotingWorkspace::Worker voting;
    const VotingInput input = voting_input({index, settings}, seen);
    for (std::size_t c = 0; c < index.forest().classes.size(); ++c) {
      cast_votes(input, static_cast<int>(c), voting.casting, voting.space);
    }
  });
  static std::vector<VotingWorkspace::Worker> by_class(index.forest().classes.size());
  const VotingInput input = voting_input({index, settings}, seen);
  for (std::size_t c = 0; c < by_class.size(); ++c) {
    cast_votes(input, static_cast<int>(c), by_class[c].casting, by_class[c].space);
  }
  add("hypotheses", [&index, &settings] {
    const VotingInput again = voting_input({index, settings}, seen);
    for (std::size_t c = 0; c < by_class.size(); ++c) {
      benchmark::DoNotOptimize(class_hypotheses(again, c, by_class[c]));
    }
  });
}

}  // namespace

void register_kernels(const RgbdFrame& frame, const ForestIndex& index, const DetectionSettings& settings) {
  register_codecs(frame);
  register_features(frame, index.forest());
  register_search(frame, index, settings);
}

}  // namespace houghstream
