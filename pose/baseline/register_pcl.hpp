#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "pose/registration/registration.hpp"

namespace houghstream {

/// Returns the motion of a 4x4 matrix, its rotation made exact again after rounding.
Eigen::Isometry3d rigid_motion(const Eigen::Matrix4d& matrix);

/// Registers points as the reference does: pcl::IterativeClosestPoint, point to plane, of the measured points (camera
/// frame, metres) to those of the model that are visible at the start.
RegistrationResult register_points_pcl(const std::vector<Eigen::Vector3f>& points_camera, const ObjectModel& model,
                                       const Eigen::Isometry3d& T_camera_object, const RegistrationStage& stage,
                                       const RegistrationSettings& settings);

/// Registers the region's points, as an engine: RegistrationSettings::engine = register_pcl.
RegistrationResult register_pcl(const ObjectObservation& observation, const Eigen::Isometry3d& T_camera_object,
                                const RegistrationStage& stage, const RegistrationSettings& settings);

}  // namespace houghstream
