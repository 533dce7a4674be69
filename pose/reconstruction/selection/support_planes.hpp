#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "pipeline/geometry/plane_fit.hpp"
#include "pipeline/types/frame.hpp"

namespace houghstream::reconstruction {

/// Returns planes on which objects may stand, the largest first, camera frame, metres: found by RANSAC
/// (find_largest_plane) in the depth up to `max_distance_m`, refined by least squares; only those that face upwards or
/// the camera. The same input and seed give the same result.
std::vector<Plane> find_planes(const RgbdFrame& frame, double max_distance_m, std::uint64_t seed);

/// Returns the plane nearest to the measured points that are close to it, of those pixels where `mask` (CV_8UC1, may be
/// empty) is 0 and within `radius_m` of `middle`.
Plane refine_plane(const RgbdFrame& frame, const cv::Mat& mask, const Plane& plane, const Eigen::Vector3d& middle,
                   double radius_m);

}  // namespace houghstream::reconstruction
