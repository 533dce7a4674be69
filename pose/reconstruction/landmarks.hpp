#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "pipeline/types/frame.hpp"

namespace houghstream::reconstruction {

/// Corners of a picture that have depth, as they are found again from elsewhere.
struct Landmarks {
  std::vector<Eigen::Vector3d> points;  ///< camera frame, metres
  cv::Mat descriptors;                  ///< a row each
};

/// ORB (Rublee, Rabaud, Konolige, Bradski 2011). `mask` (CV_8UC1 of the frame's size, or empty) says where.
Landmarks find_landmarks(const RgbdFrame& frame, const cv::Mat& mask);

/// How one picture's landmarks lie on another's.
struct LandmarkMatch {
  Eigen::Isometry3d T_b_a = Eigen::Isometry3d::Identity();  ///< from camera a to camera b
  int inliers = 0;                                          ///< pairs within a few millimetres of it
};

/// From pairs of like corners by RANSAC; none where fewer than eight pairs agree. Same input, same result.
std::optional<LandmarkMatch> match_landmarks(const Landmarks& a, const Landmarks& b);

}  // namespace houghstream::reconstruction
