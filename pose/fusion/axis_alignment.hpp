#pragma once

#include <vector>

#include "pose/fusion/depth_view.hpp"

namespace houghstream::fusion {

/// Settings of the registration of a model's views to each other.
struct AlignmentSettings {
  int iterations = 15;         ///< Gauss-Newton iterations; 0 = none
  int neighbours = 8;          ///< views that each one is compared with, the nearest in direction
  int points_per_view = 1200;  ///< compared points
  double max_pair_m = 0.01;    ///< Tukey's limit: what is farther apart is not the same surface
  double damping = 2e-4;       ///< weight of a motion by the object's size, against the measured distances
  int threads = 1;             ///< any number gives the same result
};

/// Point-to-plane error of views over all compared points.
struct AlignmentError {
  int pairs = 0;
  double median_m = 0.0;  ///< median of the absolute distances; 0 without pairs
};

/// Measures the distances between each view's points and its neighbours' surfaces.
AlignmentError measure_alignment_error(const std::vector<DepthView>& views, const AlignmentSettings& settings);

/// Corrects T_camera_object of the views in place by one motion of the object frame in the camera's, common to all
/// views: for a turntable in front of a fixed camera, whose steps are exact, this corrects the axis and nothing else.
/// It runs Gauss-Newton on the distances between the views' points and their neighbours' tangent planes (Chen & Medioni
/// 1992), with pairs found by projection (Blais & Levine 1995). Motions that the distances do not determine (a rotation
/// about the axis, a shift along it) stay as they are.
void align_views(std::vector<DepthView>& views, const AlignmentSettings& settings);

}  // namespace houghstream::fusion
