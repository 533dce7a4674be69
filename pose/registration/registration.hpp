#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <vector>

#include "pipeline/types/frame.hpp"
#include "pose/model/object_model.hpp"
#include "pose/pose_settings.hpp"

namespace houghstream {

/// A candidate after registration with its evidence.
struct RegistrationResult {
  Eigen::Isometry3d T_camera_object = Eigen::Isometry3d::Identity();
  bool converged = false;  ///< the last step was small; false too where there were not enough pairs for a step
  int iterations = 0;
  int inliers = 0;  ///< model points with a measured point within the last pair distance
  float inlier_fraction = 0.0F;
  float residual = std::numeric_limits<float>::quiet_NaN();  ///< RMS distance of the inliers along normals, metres
};

/// The motion that a 4x4 matrix stands for, its rotation made exact again after rounding.
Eigen::Isometry3d rigid_motion(const Eigen::Matrix4d& matrix);

/// How far one registration goes: pairs farther apart than the distance, which shrinks from start to end, have no
/// weight. Distances in metres.
struct RegistrationStage {
  int iterations = 0;
  int points = 0;  ///< of the model's view, at most
  double start_distance_m = 0.0;
  double end_distance_m = 0.0;
  int search_steps = 2;  ///< ours: measured points looked at to each side of a model point's pixel
};

/// Ours: each visible model point is paired with the nearest measured point about its pixel (projective data
/// association, Blais & Levine 1995), and one step of Gauss-Newton lowers the distances along the model's normals
/// (Chen & Medioni 1992) under Tukey's weights. What lies in front of the model or behind it finds no pair.
RegistrationResult register_projective(const RgbdFrame& frame, const ObjectModel& model,
                                       const Eigen::Isometry3d& T_camera_object, const RegistrationStage& stage,
                                       const RegistrationSettings& settings);

/// The reference: pcl::IterativeClosestPoint, point to plane, of the measured points (camera frame, metres) to those of
/// the model that are visible at the start.
RegistrationResult register_pcl(const std::vector<Eigen::Vector3f>& points_camera, const ObjectModel& model,
                                const Eigen::Isometry3d& T_camera_object, const RegistrationStage& stage,
                                const RegistrationSettings& settings);

}  // namespace houghstream
