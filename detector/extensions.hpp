#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "detector/features/feature_families.hpp"
#include "pipeline/types/frame.hpp"

namespace houghstream {

struct Candidate;
struct Search;
struct WorkingFrame;

constexpr const char* kBaselineFolder = "detector/baseline (hs-study-train, hs-study-evaluate, hs-hough)";

/// What exists for comparisons only, in detector/baseline: the product's programs are linked without it. A program that
/// has it says so by baseline::use_baseline(), once, in main, before it starts threads.
struct Extensions {
  /// The planes of a surface family (is_surface_family) before minimum and maximum, CV_8UC1.
  std::vector<cv::Mat> (*surface_planes)(FeatureFamily family, const WorkingFrame& frame, int threads) = nullptr;
  /// All candidates of a frame by a forest of ScaleHandling::kScaleSpace; closes the stages "detect.*" up to evidence.
  std::vector<Candidate> (*search_scale_space)(const Search& search, const RgbdFrame& frame,
                                               StageClock& clock) = nullptr;
};

/// Not to be called while other threads use the detector.
void extend_detector(const Extensions& extensions);

/// What the program has; all nullptr in the product.
const Extensions& extensions();

/// Throws InputError in one line that names `source`, for instance a forest file, what it needs and who has it, unless
/// this program has all that these settings need.
void require_extensions(const FeatureSettings& settings, const std::string& source);

}  // namespace houghstream
