#pragma once

#include <opencv2/core.hpp>
#include <optional>

#include "pipeline/types/training_view.hpp"

namespace houghstream {

/// A training view as the same camera, or one of another focal length, would see it from another distance: the image is
/// resized, the depth shifted (an object does not grow deeper by standing farther off). Sides are even, and there is a
/// margin without mask around it.
struct ScaledView {
  cv::Mat colour;           ///< CV_8UC3, BGR
  cv::Mat depth_mm;         ///< CV_16UC1, millimetres, 0 = none; none outside the mask
  cv::Mat mask;             ///< CV_8UC1, 255 on the object
  cv::Point2d origin_px;    ///< where the object frame's origin is seen
  double distance = 0.0;    ///< of the object frame's origin along the optical axis, metres
  double view_scale = 1.0;  ///< size here over size in the view
};

/// `focal_px` of the camera that sees it; 0: that of the view. Nothing where nothing is left of the mask or of the
/// depth on it. The view's object must stand in front of the camera.
std::optional<ScaledView> scale_view(const TrainingView& view, double distance, double focal_px = 0.0);

}  // namespace houghstream
