#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <opencv2/core.hpp>
#include <vector>

#include "pipeline/types/camera.hpp"

namespace houghstream::baseline {

/// The paper's surface features (Section 3, items 5 to 7) look at the k nearest neighbours of a point. Here the image
/// itself says who is near: the neighbours of a pixel are those in a square window of about k pixels that lie on its
/// own side of any depth step. No search is needed, and on a surface that faces the camera the two are the same.

/// Returns half the width, in pixels and without the middle, of the odd square window whose size is nearest to
/// `neighbours`.
int surface_window_radius(int neighbours);

/// Metres by which a neighbour's depth may differ from the middle's, `depth`, to be on the same surface: up to a slope
/// of 56 degrees the whole window is, and steeper surfaces lose as much on one side as on the other. At least 2 cm, so
/// that the sensor's noise does not split a surface. NaN for NaN.
float same_surface_limit(const Camera& camera, float depth, int radius_px);

/// Returns the limit for a support of this radius, metres.
float same_surface_limit(double radius_m);

/// One 3-vector per pixel of an image.
struct SurfaceVectors {
  std::array<cv::Mat, 3> xyz;  ///< CV_32FC1 each
  cv::Mat depth;               ///< CV_32FC1, metres, NaN where there is no vector
  Camera camera;
};

struct WindowMoments {
  int count = 0;  ///< neighbours on the same surface, the pixel itself included; 0 where it has no vector
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< covariance of their vectors, divided by count
};

/// Returns for every pixel of row y the moments of the vectors around it.
std::vector<WindowMoments> row_moments(const SurfaceVectors& vectors, int y, int radius_px);

/// The pixels from first_x up to but without last_x of a row have a neighbour at (x + dx, y_neighbour).
struct WindowShift {
  int y_neighbour = 0;
  int dx = 0;
  int first_x = 0;
  int last_x = 0;
};

/// Calls visit(shift) for each row and shift of the window around the pixels of row y.
template <typename Visit>
void for_each_shift(cv::Size size, int y, int radius_px, const Visit& visit) {
  for (int v = std::max(0, y - radius_px); v <= std::min(size.height - 1, y + radius_px); ++v) {
    for (int dx = -radius_px; dx <= radius_px; ++dx)
      visit(WindowShift{v, dx, std::max(0, -dx), std::min(size.width, size.width - dx)});
  }
}

}  // namespace houghstream::baseline
