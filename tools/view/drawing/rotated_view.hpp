#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <optional>

#include "pipeline/types/frame.hpp"
#include "tools/view/drawing/overlay.hpp"

namespace houghstream::view {

/// From the frame's camera to the place from which draw_rotated_view() looks: moved to the right and up about the
/// middle of what was measured (`depth`: CV_32FC1, metres).
Eigen::Isometry3d rotated_camera(const cv::Mat& depth);

/// What was measured, as points in their colours seen from rotated_camera(), with outlines and axes of the poses, of
/// the frame's size (CV_8UC3, BGR). Dark where no point is.
cv::Mat draw_rotated_view(const RgbdFrame& frame, const std::optional<ObjectPoses>& poses, const ClassModels& models);

}  // namespace houghstream::view
