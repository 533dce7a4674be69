#pragma once

#include <opencv2/core.hpp>

#include "detector/detector_settings.hpp"
#include "pipeline/frame.hpp"

namespace houghstream {

/// A frame at the size the detector works at.
struct WorkingFrame {
  cv::Mat colour;        ///< CV_8UC3 BGR
  cv::Mat filled_depth;  ///< CV_32FC1, metres; holes borrow the nearest measured depth, NaN where it is too far away
  Camera camera;         ///< of these images
};

/// Resizes (paper, Section 5.1.1) and closes small holes. Of each 2x2 block the nearest surface counts, so that
/// foreground and background are never averaged into a surface that is not there.
WorkingFrame make_working_frame(const RgbdFrame& frame, const FeatureSettings& settings);

}  // namespace houghstream
