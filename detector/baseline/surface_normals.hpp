#pragma once

#include <opencv2/core.hpp>

#include "detector/baseline/surface_window.hpp"
#include "detector/features/working_frame.hpp"

namespace houghstream::baseline {

/// Computes unit normals, CV_32FC3 in the camera frame, pointing towards the camera: of the plane fitted by covariance
/// (as PCL's NormalEstimation does) to the surface around each pixel, in the organised image (surface_window.hpp), not
/// by search. NaN where depth is missing and where less than a quarter of the window lies on the same surface.
cv::Mat surface_normals(const WorkingFrame& frame, int neighbours, int threads);

/// Returns the normal of the least-squares plane of points with this covariance, oriented towards the camera.
Eigen::Vector3d facing_normal(const Eigen::Matrix3d& covariance, const Eigen::Vector3d& ray);

/// Returns the normals as vectors whose windows can be summed.
SurfaceVectors normal_vectors(const WorkingFrame& frame, const cv::Mat& normals);

}  // namespace houghstream::baseline
