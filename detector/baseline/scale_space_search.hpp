#pragma once

#include <vector>

#include "detector/baseline/reference_stages.hpp"
#include "detector/stages.hpp"

namespace houghstream::baseline {

/// Returns the sizes of FeatureSettings::scales, each of which searches the whole image.
std::vector<FeatureLevel> scale_space_levels(const FeatureSettings& settings);

/// Returns the frame at such a size. Nothing is known of depth, so that a hole borrows that of the nearest pixel.
WorkingFrame scale_space_frame(const RgbdFrame& frame, const FeatureLevel& level, const FeatureSettings& settings);

/// Searches as the original Hough Forest does (Gall et al. 2011, Section 3.3): the frame is searched in every size of
/// FeatureSettings::scales, each pixel votes in the image for the centres it knows, and each size has a Hough image of
/// its own; candidates are the maxima over place and size, see maxima_over_sizes. Boxes by back-projection of all
/// supporting patches. A candidate's centre has no depth: centre_camera is NaN. Same result for any number of threads.
/// Closes the stages "detect.resize", "detect.features", "detect.leaves" and "detect.votes" on the clock.
std::vector<ScoredHypothesis> search_scale_space(const SearchContext& search, Way way, const RgbdFrame& frame,
                                                 StageClock& clock);

/// Returns the Hough images of one class before maxima are taken, one per size, CV_32FC1: vote mass as a fraction of
/// the expected one of a wholly visible object.
std::vector<cv::Mat> scale_space_hough_images(const SearchContext& search, int class_index, const RgbdFrame& frame);

/// A maximum of the Hough image of one class in one size of the frame.
struct ScalePeak {
  ScoredHypothesis candidate;
  cv::Point2f at_px;      ///< frame pixels
  float reach_px = 0.0F;  ///< it is the highest of its size at most so far away along either axis, frame pixels
  int size = 0;           ///< index of the size in FeatureSettings::scales
};

/// Returns the maxima over all sizes. The voting space has a third axis, the size (paper, Section 2: maxima over place,
/// class and scale; Gall et al. 2011, Section 3.3): a maximum of one size that a higher one of the next size stands
/// beside is a slope of that one. Of a class's equal neighbours the first counts. What is left keeps its order.
std::vector<ScoredHypothesis> maxima_over_sizes(const std::vector<ScalePeak>& peaks);

}  // namespace houghstream::baseline
