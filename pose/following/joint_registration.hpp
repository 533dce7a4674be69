#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <memory>

#include "pipeline/base/settings_fields.hpp"
#include "pose/following/region_modality.hpp"
#include "pose/following/texture_modality.hpp"
#include "pose/registration/depth_equations.hpp"
#include "pose/registration/registration.hpp"

namespace houghstream {

/// How what is followed is registered to depth and colours at once.
struct JointSettings {
  int points = 400;           ///< of the model's view, at the finest level
  double start_m = 0.03;      ///< pairs of depth farther apart have no weight, at the coarsest level
  double depth_sigmas = 1.4;  ///< standard deviation that a pair of depth is given, over its noise
  // Regularisation after Tikhonov (Stoiber et al. 2022, "Iterative Corresponding Geometry", equation 21): what nothing
  // observes stays as it was.
  double tikhonov_rad = 0.015;  ///< standard deviation of a step's rotation
  double tikhonov_m = 0.006;    ///< and of its shift
  RegionModalitySettings region;
  TextureModalitySettings texture;
};

template <typename Visit>
void fields(const JointSettings& /*settings*/, const Visit& visit) {
  using S = JointSettings;
  visit(number("points", &S::points, 1, 100000));
  visit(number("start_m", &S::start_m, 0, 1, "m"));
  visit(number("depth_sigmas", &S::depth_sigmas, 1e-3, 1e3));
  visit(number("tikhonov_rad", &S::tikhonov_rad, 1e-6, 1e6, "rad"));
  visit(number("tikhonov_m", &S::tikhonov_m, 1e-6, 1e6, "m"));
  visit(group("region", &S::region));
  visit(group("texture", &S::texture));
}

/// What is known of a followed object's appearance.
struct FollowedAppearance {
  std::shared_ptr<const ColourStatistics> colours;  ///< nothing: none have been learnt, depth alone is measured
  std::shared_ptr<const Silhouette> silhouette;     ///< of an earlier frame, or nothing
  std::shared_ptr<const TextureKeyframe> texture;   ///< of an earlier frame, or nothing
};

/// Moves a pose to where something else than depth and silhouette speaks for it.
using RefinePose = std::function<Eigen::Isometry3d(const Eigen::Isometry3d& T_camera_object)>;

/// One standard deviation of the object's motion between a frame's depth and its colours, which a camera takes apart in
/// time: about its origin, along the camera's axes.
struct DepthLag {
  Eigen::Vector3d rotation_rad = Eigen::Vector3d::Zero();
  Eigen::Vector3d shift_m = Eigen::Vector3d::Zero();
};

/// From where on an object is registered.
struct JointStart {
  Eigen::Isometry3d T_camera_object = Eigen::Isometry3d::Identity();
  FollowedAppearance appearance;
  /// After the coarser half of the levels; may be empty. From there on the texture of an earlier frame says nothing.
  RefinePose refine_by_texture;
  DepthLag depth_lag;  ///< along it, colours say where the object is, and depth as far as it is short
};

/// Where joint registration ended.
struct JointResult {
  RegistrationResult registration;  ///< its evidence is that of depth
  /// Of the motion of MotionEquations, in the inverse square of metres: what depth across surfaces, edges of colour and
  /// texture say. A direction that none of them observes has none.
  Matrix6d information = Matrix6d::Zero();
  std::shared_ptr<const Silhouette> silhouette;  ///< that it used last, or nothing
  int edges = 0;                                 ///< lines with an edge, at the finest level
  int blank = 0;                                 ///< lines without one
  int covered = 0;                               ///< points of the silhouette behind nearer depth
};

/// Registers the model from a start: at each of a few levels, from coarse to fine, lines and pairs are found and the
/// sum of their normal equations and of the regularisation is solved twice. Depth: point to plane (build_equations);
/// colours: region_equations; texture: texture_equations. Depth or colours suffice.
JointResult register_jointly(const ObjectObservation& observation, const JointStart& start,
                             const JointSettings& settings, const RegistrationSettings& registration);

/// Of the rotation about the model's centre, what remains when it is multiplied by how surely it was observed, beside
/// what a step's regularisation would hold: the identity where all is known, 0 where nothing is. `radius`: the model's.
Eigen::Matrix3d observed_rotation(const Matrix6d& information, double radius, const JointSettings& settings);

}  // namespace houghstream
