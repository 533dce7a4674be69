#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "pipeline/types/frame.hpp"
#include "pose/model/view_look.hpp"
#include "pose/pose_settings.hpp"

namespace houghstream {

/// The colours of a part of a frame.
struct LabRegion {
  cv::Mat lab;          ///< CV_8UC3, 8-bit CIE L*a*b*, of the part; neighbouring pixels averaged against noise
  cv::Point origin_px;  ///< its first pixel in the frame
};
LabRegion lab_region(const RgbdFrame& frame, const cv::Rect& part_px);

/// How the colours that the model has at a pose and those that are seen compare, where measured and model depth agree.
struct ColourComparison {
  int points = 0;  ///< compared
  /// 1 less the share of the seen variance that is left over, with each channel's gain (within limits) and offset free,
  /// as exposure and the light's colour decide them, and lightness also free to follow the surface's normals, as
  /// shading does. Near 0, or below, for unrelated prints.
  float agreement = 0.0F;
  float left_over = 0.0F;     ///< standard deviation of the seen colours that is left over, 8-bit CIE L*a*b*
  float chroma_shift = 0.0F;  ///< length of the mean difference between seen and remembered a* and b*
};

/// Compares the points that were looked at. Nothing where the model has no colours or too few points agree.
std::optional<ColourComparison> compare_colours(const LabRegion& colours, const ViewLook& seen,
                                                const DepthTolerance& tolerance);

/// Depth and colour together: the square root of `depth_value` (DepthScore::value), whose noise would else drown what
/// little the turns of a round thing differ in colour, less a part where the colours do not explain what is seen.
/// `depth_value` itself where that is not above 0.
float joint_score(float depth_value, const std::optional<ColourComparison>& colour);

}  // namespace houghstream
