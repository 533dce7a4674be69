#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "pose/reconstruction/map/frame_levels.hpp"

namespace houghstream::reconstruction {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// The support plane, where it is known: its height and slope constrain three of six degrees of freedom.
struct PlanePrior {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< camera frame, unit length, upwards
  double offset = 0.0;                                ///< normal.X + offset = 0 on the table
  double sigma_m = 0.0005;   ///< standard deviation of the height of the world's origin above it
  double sigma_rad = 0.004;  ///< standard deviation of the world's z axis
};

/// A landmark that was observed again.
struct LandmarkObservation {
  Eigen::Vector3d in_world = Eigen::Vector3d::Zero();   ///< metres
  Eigen::Vector3d in_camera = Eigen::Vector3d::Zero();  ///< observed position, metres; only its bearing counts
};

/// Constraints of a frame's pose besides geometry and intensity.
struct PoseConstraints {
  std::optional<PlanePrior> plane;
  std::vector<LandmarkObservation> landmarks;
};

struct AlignmentLimits {
  int iterations = 7;               ///< maximum on each level
  int coarsest = 2;                 ///< level to begin on
  int finest = 0;                   ///< level to end on
  double photometric_sigma = 0.35;  ///< standard deviation of FrameLevel::intensity
  double gate_m = 0.014;            ///< maximum distance of a pair on the finest level; twice that on the next
  double min_step_m = 1e-4;         ///< a step that moves nothing farther ends a level
  bool use_photometric = true;
};

/// Holds the registration of a frame to surface points, with its statistics.
struct Alignment {
  Eigen::Isometry3d T_camera_world = Eigen::Isometry3d::Identity();
  Matrix6 information = Matrix6::Zero();  ///< information of a twist for retract_about_body(), at the end
  int pairs = 0;                          ///< points with a measured partner
  double inlier_fraction = 0.0;           ///< fraction of the visible points in the image that have a partner
  double visible_point_fraction = 0.0;  ///< fraction of all points that are in the image, not occluded, and have depth
  double geometric_rms_m = 0.0;         ///< root mean square of the pairs' distances along normals
  double photometric_rms = 0.0;         ///< root mean square of the pairs' intensity differences, robust
};

/// Registers a frame to surface points: point-to-plane distances (Chen & Medioni 1992) of projective correspondences
/// (Blais & Levine 1995), intensity differences (Steinbruecker, Sturm, Cremers, "Real-time visual odometry from dense
/// RGB-D images", ICCVW 2011), and bearings of landmarks are minimised jointly by Gauss-Newton with Tukey's weights,
/// from coarse to fine. `points` lie in the world frame, as many levels as the frame's. Thread-safe.
Alignment align_frame(const LevelPoints& points, const FrameLevels& frame, const Eigen::Isometry3d& T_camera_world,
                      const PoseConstraints& constraints, const AlignmentLimits& limits);

/// Returns the statistics of a frame at a fixed pose, on one level.
Alignment compare_frame(const LevelPoints& points, const FrameLevels& frame, const Eigen::Isometry3d& T_camera_world,
                        int level);

/// Returns the distance between a landmark's observed and predicted bearing in the pinhole's plane (tangents), radians;
/// infinite where the landmark is behind the camera.
double bearing_error(const LandmarkObservation& landmark, const Eigen::Isometry3d& T_camera_world);

}  // namespace houghstream::reconstruction
