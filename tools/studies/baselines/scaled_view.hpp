#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "pipeline/types/frame.hpp"
#include "pipeline/types/training_view.hpp"

namespace houghstream {

/// Steps in pixels of cv::linemod on an image and on its half: its own defaults.
constexpr std::array<int, 2> kLinemodSteps = {5, 8};

/// Returns the frame in the form that cv::linemod takes: colour (CV_8UC3) and millimetres (CV_16UC1, 0 = none). It is
/// enlarged to the right and below by pixels without structure for two reasons. The size must be a whole number of
/// steps, and rows must have multiples of 16 bytes also at half size: cv::linemod asserts the former and reads
/// unaligned rows as if they were aligned (opencv_contrib#4194). Also `largest`, the largest template, must fit with
/// eight steps on each side, or it is not found where it is.
std::vector<cv::Mat> linemod_images(const RgbdFrame& frame, cv::Size largest);

/// A training view as the same camera, or one of another focal length, would see it from another distance: the image is
/// resized, the depth shifted (an object does not grow deeper by standing farther off). Sides are even, and there is a
/// margin without mask around it.
struct ScaledView {
  cv::Mat colour;           ///< CV_8UC3, BGR
  cv::Mat depth_mm;         ///< CV_16UC1, millimetres, 0 = none; none outside the mask
  cv::Mat mask;             ///< CV_8UC1, 255 on the object
  cv::Point2d origin_px;    ///< pixel of the object frame's origin
  double distance = 0.0;    ///< depth of the object frame's origin, metres
  double view_scale = 1.0;  ///< size here over size in the view
};

/// `focal_px` is of the scenes' camera; 0: that of the view. Returns nothing where nothing is left of the mask or of
/// the depth on it. The view's object must be in front of the camera.
std::optional<ScaledView> scale_view(const TrainingView& view, double distance, double focal_px = 0.0);

}  // namespace houghstream
