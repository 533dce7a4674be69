#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <string>

// Checks of a pose or a box received from the wire.

namespace houghstream {

/// A unit vector or quaternion in single precision, rounded by another sender, is this close to length 1.
inline constexpr double kUnitTolerance = 1e-3;

/// The limits lie beyond the Moon: no camera's world is larger, and no box reaches so many pixels. Code that draws or
/// adds positions need not check for overflows.
inline constexpr double kMaxDistanceM = 1e9;
inline constexpr float kMaxDistancePx = 1e6F;

/// Returns the rigid motion of a translation, metres, and a quaternion, w first. Throws InputError that begins with
/// `of` where it is invalid or lies beyond kMaxDistanceM; `or_else` names what would have been accepted too.
Eigen::Isometry3d pose_from_wire(const double* trans, const double* quat, const std::string& of,
                                 const char* or_else = "");

/// Throws InputError that begins with `of` for a box that is empty, or not within kMaxDistancePx.
void check_wire_box(const cv::Rect2f& box, const std::string& of, const char* or_else = "");

}  // namespace houghstream
