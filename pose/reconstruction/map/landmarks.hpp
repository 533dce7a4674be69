#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "pipeline/types/frame.hpp"

namespace houghstream::reconstruction {

/// Corners of an image that have depth, with descriptors by which other views find them again.
struct Landmarks {
  std::vector<Eigen::Vector3d> points;  ///< camera frame, metres
  cv::Mat descriptors;                  ///< a row each
};

/// Detects ORB landmarks (Rublee, Rabaud, Konolige, Bradski 2011). `mask` (CV_8UC1 of the frame's size, or empty)
/// limits the pixels.
Landmarks detect_landmarks(const RgbdFrame& frame, const cv::Mat& mask);

/// Holds the match of the landmarks of two images.
struct LandmarkMatch {
  Eigen::Isometry3d T_b_a = Eigen::Isometry3d::Identity();           ///< motion from camera a to camera b
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> inliers;  ///< points in a and b
};

/// Matches similar corners by RANSAC (Fischler & Bolles 1981); returns nothing where fewer than eight pairs agree. The
/// same input gives the same result.
std::optional<LandmarkMatch> match_landmarks(const Landmarks& a, const Landmarks& b);

/// A frame from which, or into which, corners are tracked, with its brightness, which is computed once for both.
struct FlowFrame {
  RgbdFrame frame;
  cv::Mat grey;                  ///< CV_8UC1
  std::vector<cv::Mat> pyramid;  ///< pyramid of `grey`, with gradients, for OpenCV's optical flow
};

FlowFrame make_flow_frame(const RgbdFrame& frame);

/// Detects corners that can be tracked from a frame (Shi & Tomasi 1994), pixels. `mask`: as for detect_landmarks.
std::vector<cv::Point2f> detect_flow_corners(const FlowFrame& frame, const cv::Mat& mask);

/// Tracks corners of one frame into the next, in which they are nearly in the same place (Lucas & Kanade 1981), forth
/// and back.
std::optional<LandmarkMatch> track_corners(const FlowFrame& a, const std::vector<cv::Point2f>& corners,
                                           const FlowFrame& b);

}  // namespace houghstream::reconstruction
