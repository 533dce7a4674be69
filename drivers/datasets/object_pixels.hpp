#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "pipeline/types/camera.hpp"

namespace houghstream {

/// Holds a coloured point of an object's visible surface.
struct ColouredPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< camera frame, metres
  cv::Vec3b colour;                                    ///< BGR
};

/// Counts pixels of `mask` (CV_8UC1) that have depth (CV_32FC1, NaN = none).
int count_depth_pixels(const cv::Mat& depth, const cv::Mat& mask);

/// Returns the pixels as points, row by row.
std::vector<ColouredPoint> object_points(const cv::Mat& colour, const cv::Mat& depth, const cv::Mat& mask,
                                         const Camera& camera);

}  // namespace houghstream
