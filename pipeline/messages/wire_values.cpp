#include "pipeline/messages/wire_values.hpp"

#include <cmath>

#include "pipeline/base/checks.hpp"

namespace houghstream {

Eigen::Isometry3d pose_from_wire(const double* trans, const double* quat, const std::string& of, const char* or_else) {
  const Eigen::Map<const Eigen::Vector3d> translation(trans);
  const Eigen::Quaterniond q(quat[0], quat[1], quat[2], quat[3]);
  require(translation.allFinite() && translation.cwiseAbs().maxCoeff() <= kMaxDistanceM,
          "{} at ({}, {}, {}), expected metres within {}{}", of, trans[0], trans[1], trans[2], kMaxDistanceM, or_else);
  require(std::abs(q.norm() - 1.0) < kUnitTolerance, "{} with a quaternion of length {}, expected 1{}", of, q.norm(),
          or_else);
  return Eigen::Translation3d(translation) * q.normalized();
}

void check_wire_box(const cv::Rect2f& box, const std::string& of, const char* or_else) {
  const bool is_box = std::abs(box.x) <= kMaxDistancePx && std::abs(box.y) <= kMaxDistancePx && box.width > 0.0F &&
                      box.width <= kMaxDistancePx && box.height > 0.0F &&
                      box.height <= kMaxDistancePx;  // false for NaN too
  require(is_box, "{} at ({}, {}) of {}x{} pixels, expected positive sizes, all within {}{}", of, box.x, box.y,
          box.width, box.height, kMaxDistancePx, or_else);
}

}  // namespace houghstream
