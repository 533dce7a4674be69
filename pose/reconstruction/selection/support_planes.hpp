#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "pipeline/types/frame.hpp"

namespace houghstream::reconstruction {

/// Gives the plane normal.X + offset = 0 for its points X; camera frame, metres.
struct Plane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit length, towards the camera
  double offset = 0.0;                                ///< the camera's height above it

  double height(const Eigen::Vector3d& point) const { return normal.dot(point) + offset; }
};

/// Planes on which things may stand, the largest first: RANSAC (Fischler & Bolles 1981) on the depth up to
/// `max_distance_m`, refined by least squares; only such as face upwards or the camera. Same input and seed, same
/// result.
std::vector<Plane> find_planes(const RgbdFrame& frame, double max_distance_m, std::uint64_t seed);

/// The plane nearest to the measured points that are close to it, of those pixels where `mask` (CV_8UC1, may be empty)
/// is 0 and within `radius_m` of `middle`.
Plane refine_plane(const RgbdFrame& frame, const cv::Mat& mask, const Plane& plane, const Eigen::Vector3d& middle,
                   double radius_m);

}  // namespace houghstream::reconstruction
