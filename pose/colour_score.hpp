#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "pipeline/frame.hpp"
#include "pose/object_model.hpp"
#include "pose/pose_settings.hpp"

namespace houghstream {

/// The colours of a part of a frame.
struct LabRegion {
  cv::Mat lab;          ///< CV_8UC3, 8-bit CIE L*a*b*, of the part; neighbouring pixels averaged against noise
  cv::Point origin_px;  ///< its first pixel in the frame
};
LabRegion lab_region(const RgbdFrame& frame, const cv::Rect& part_px);

/// How far the colours that the model has at a pose explain those that are seen: 1 less the share of the seen variance
/// that is left over, with each channel's gain (within limits) and offset free, as exposure and the light's colour
/// decide them, and lightness also free to follow the surface's normals, as shading does. Near 0, or below, for
/// unrelated prints. Looks at the first `points` points of the view nearest to the pose, where measured and model depth
/// agree. Nothing where the model has no colours or too few points are seen.
std::optional<float> colour_agreement(const RgbdFrame& frame, const LabRegion& colours, const ObjectModel& model,
                                      const Eigen::Isometry3d& T_camera_object, int points,
                                      const DepthTolerance& tolerance);

/// Depth and colour together: `depth_value` (DepthScore::value), less a part where the colours do not explain what is
/// seen.
float joint_score(float depth_value, std::optional<float> colour);

}  // namespace houghstream
