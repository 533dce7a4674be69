#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <optional>

#include "pipeline/types/frame.hpp"
#include "tools/view/drawing/overlay.hpp"

namespace houghstream::view {

/// Returns the pose from the frame's camera to the position from which draw_rotated_view() looks: moved to the right
/// and up about the middle of the measured points (`depth`: CV_32FC1, metres).
Eigen::Isometry3d rotated_camera(const cv::Mat& depth);

/// Draws the measured points in their colours as seen from rotated_camera(), with outlines and axes of the poses, in
/// the frame's size (CV_8UC3, BGR). Pixels without a point are dark.
cv::Mat draw_rotated_view(const RgbdFrame& frame, const std::optional<ObjectPoses>& poses, const ClassModels& models);

}  // namespace houghstream::view
