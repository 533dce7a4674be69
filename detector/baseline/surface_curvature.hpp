#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "detector/baseline/surface_window.hpp"
#include "detector/features/working_frame.hpp"

namespace houghstream::baseline {

/// Principal curvature (Arbeiter et al. 2012; paper, Section 3, item 6) with the sizes of Section 4, in the organised
/// image: normals of 100 neighbours, curvature of 225.
struct CurvatureLayout {
  static constexpr int kNormalNeighbours = 100;
  static constexpr int kNeighbours = 225;
  static constexpr int kMax = 0;        ///< spread of the normals along the principal direction
  static constexpr int kMin = 1;        ///< curvature across it
  static constexpr int kDirection = 2;  ///< two planes: cosine and sine of twice the principal direction's angle
  static constexpr int kRatio = 4;      ///< minimum over maximum
  static constexpr int kPlanes = 5;

  static constexpr float kFullSpread = 0.7F;  ///< spread at 255: that of normals all around a half circle
};

/// Curvature at one pixel, as PCL's PrincipalCurvaturesEstimation has it: of the normals around, laid flat onto the
/// tangent plane. A sphere or cylinder of radius R under a window w metres wide has spread w / (R sqrt(12)).
struct Curvature {
  float max = 0.0F;                       ///< larger eigenvalue of their covariance
  float min = 0.0F;                       ///< smaller eigenvalue
  cv::Vec3f direction{0.0F, 0.0F, 0.0F};  ///< unit vector of the larger one, camera frame; its sign means nothing
};

/// Computes kPlanes planes CV_8UC1. Spread is the root of the eigenvalue, so that it grows as curvature does. An angle
/// in the image is known up to half a turn, so its double is kept: 128 + 127 cos and sin, drawn towards 128 as far as
/// the two curvatures are alike and no direction is the principal one. Where there is no normal: 0, direction 128.
std::vector<cv::Mat> curvature_planes(const WorkingFrame& frame, int threads);

/// Returns the curvatures of a row of normals; NaN where there is no normal.
std::vector<Curvature> row_curvatures(const SurfaceVectors& normals, int y, int radius_px);

}  // namespace houghstream::baseline
