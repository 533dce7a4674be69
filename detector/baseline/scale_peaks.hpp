#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "detector/detection_candidates.hpp"

namespace houghstream {

/// A maximum of the Hough image of one class in one size of the frame.
struct ScalePeak {
  Candidate candidate;
  cv::Point2f at_px;      ///< frame pixels
  float reach_px = 0.0F;  ///< it is the highest of its size at most so far away along either axis, frame pixels
  int size = 0;           ///< which of the sizes, counted in the order of FeatureSettings::scales
};

/// The voting space has a third axis, the size (paper, Section 2: maxima over place, class and scale; Gall et al. 2011,
/// Section 3.3): a maximum of one size that a higher one of the next size stands beside is a slope of that one. Of a
/// class's equal neighbours the first counts. What is left keeps its order.
std::vector<Candidate> maxima_over_sizes(const std::vector<ScalePeak>& peaks);

}  // namespace houghstream
