#pragma once

#include <vector>

#include "detector/detection_candidates.hpp"

namespace houghstream {

/// The search of the original Hough Forest (Gall et al. 2011, Section 3.3): the frame is looked at in every size of
/// FeatureSettings::scales, each pixel votes in the image for the centres it knows, and each size has a Hough image of
/// its own; candidates are the maxima over place and size, see scale_peaks.hpp. Boxes by back-projection of all
/// supporting patches. A candidate's centre has no depth: centre_camera is NaN. Same result for any number of threads.
std::vector<Candidate> search_scale_space(const Forest& forest, const RgbdFrame& frame,
                                          const DetectionSettings& settings, StageClock& clock);

/// The Hough images of one class before maxima are taken, one per size, CV_32FC1: vote mass as a share of what a wholly
/// visible object is expected to have.
std::vector<cv::Mat> scale_space_hough_images(const Forest& forest, int class_index, const RgbdFrame& frame,
                                              const DetectionSettings& settings);

}  // namespace houghstream
