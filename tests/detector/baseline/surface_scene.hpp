#pragma once

#include <cmath>
#include <limits>
#include <opencv2/core.hpp>
#include <random>

#include "detector/features/working_frame.hpp"

namespace houghstream::scene {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

/// Returns a frame of surfaces that are known exactly: depth_at(ray) is the depth at which the ray (x, y, 1) meets
/// them.
template <typename Surface>
WorkingFrame see(int width, int height, const Surface& depth_at) {
  WorkingFrame frame;
  frame.camera = {width, height, 260.0, 260.0, 0.5 * (width - 1), 0.5 * (height - 1)};
  frame.colour = cv::Mat(height, width, CV_8UC3, cv::Scalar(90, 90, 90));
  frame.filled_depth.create(height, width, CV_32FC1);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      frame.filled_depth.at<float>(y, x) = static_cast<float>(depth_at(frame.camera.backproject(x, y, 1.0)));
    }
  }
  return frame;
}

/// Gives the plane normal . point = offset.
struct Plane {
  Eigen::Vector3d normal;
  double offset;  ///< metres
  double operator()(const Eigen::Vector3d& ray) const { return offset / normal.dot(ray); }
};

/// Gives the cylinder around the line through `centre` along `axis`; NaN beside it. A null axis makes it a sphere.
struct Round {
  Eigen::Vector3d centre;
  double radius;  ///< metres
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
  double operator()(const Eigen::Vector3d& ray) const {
    const Eigen::Vector3d r = ray - axis * axis.dot(ray);
    const Eigen::Vector3d c = centre - axis * axis.dot(centre);
    const double half = r.dot(c);
    const double root = half * half - r.squaredNorm() * (c.squaredNorm() - radius * radius);
    return root < 0.0 ? static_cast<double>(kNone) : (half - std::sqrt(root)) / r.squaredNorm();
  }
};

/// Returns a ball of 10 cm radius on a table, before a wall.
inline WorkingFrame ball_on_table(int width = 160, int height = 120) {
  const Plane table{Eigen::Vector3d(0.0, -0.8, -0.6), -0.6};
  const Plane wall{Eigen::Vector3d(0.3, 0.0, -0.954), -1.5};
  const Round ball{Eigen::Vector3d(0.0, 0.0, 0.9), 0.1};
  return see(width, height, [&](const Eigen::Vector3d& ray) {
    double nearest = wall(ray);
    const double at_table = table(ray);
    if (at_table > 0.0 && at_table < nearest) nearest = at_table;
    const double at_ball = ball(ray);
    return at_ball < nearest ? at_ball : nearest;
  });
}

inline void add_noise(WorkingFrame& frame, double sigma_m, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, sigma_m);
  for (int y = 0; y < frame.filled_depth.rows; ++y) {
    for (int x = 0; x < frame.filled_depth.cols; ++x)
      frame.filled_depth.at<float>(y, x) += static_cast<float>(noise(random));
  }
}

/// True if all planes are the same byte for byte.
inline bool same_planes(const std::vector<cv::Mat>& a, const std::vector<cv::Mat>& b) {
  bool same = a.size() == b.size();
  for (std::size_t p = 0; same && p < a.size(); ++p) {
    same = a[p].size() == b[p].size() && a[p].type() == CV_8UC1 && b[p].type() == CV_8UC1 &&
           cv::countNonZero(a[p] != b[p]) == 0;
  }
  return same;
}

}  // namespace houghstream::scene
