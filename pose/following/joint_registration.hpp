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

/// Settings of the registration of a followed object to depth and colours at once.
struct JointSettings {
  int points = 400;           ///< points of the model's view, at the finest level
  double start_m = 0.03;      ///< distance from which a pair of depth has no weight, at the coarsest level
  double depth_sigmas = 1.4;  ///< standard deviation of a pair of depth, over the noise of depth
  // Regularisation after Tikhonov (Stoiber et al. 2022, "Iterative Corresponding Geometry", equation 21): a direction
  // that no measurement observes keeps its value.
  double tikhonov_rad = 0.015;  ///< standard deviation of a step's rotation
  double tikhonov_m = 0.006;    ///< standard deviation of a step's shift
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

/// Appearance of a followed object, as earlier frames showed it.
struct FollowedAppearance {
  std::shared_ptr<const ColourStatistics> colours;  ///< null: no colours were learnt, only depth is measured
  std::shared_ptr<const Silhouette> silhouette;     ///< appearance in an earlier frame, or null
  std::shared_ptr<const TextureKeyframe> texture;   ///< appearance in an earlier frame, or null
};

/// Moves a pose by a cue other than depth and silhouette.
using RefinePose = std::function<Eigen::Isometry3d(const Eigen::Isometry3d& T_camera_object)>;

/// One standard deviation of the object's motion between a frame's depth and its colours, which a camera takes apart in
/// time: about its origin, along the camera's axes.
struct DepthLag {
  Eigen::Vector3d rotation_rad = Eigen::Vector3d::Zero();
  Eigen::Vector3d shift_m = Eigen::Vector3d::Zero();
};

/// Evidence of one registration for the lag, without its prior, in information form: the estimate is the sum of
/// `weighted` over registrations divided by that of `information`.
struct LagEvidence {
  double information = 0.0;  ///< inverse variance, of deviations; 0: nothing
  double weighted = 0.0;     ///< information times the lag, in deviations; positive where depth is the later one
};

/// Start of a joint registration.
struct JointStart {
  Eigen::Isometry3d T_camera_object = Eigen::Isometry3d::Identity();
  FollowedAppearance appearance;
  /// Refines the pose by texture after the coarser half of the levels; may be empty. The later levels ignore the
  /// texture of an earlier frame.
  RefinePose refine_by_texture;
  DepthLag depth_lag;  ///< motion by which depth may be older than the colours
};

/// Result of a joint registration.
struct JointResult {
  RegistrationResult registration;  ///< pose, with the evidence of depth alone
  /// Information on the motion of MotionEquations, in the inverse square of metres, from depth across surfaces, edges
  /// of colour and texture. A direction that none of them observes has none.
  Matrix6d information = Matrix6d::Zero();
  std::shared_ptr<const Silhouette> silhouette;  ///< silhouette that it used last, or null
  LagEvidence lag;                               ///< of a moving object that depth and colours show both
  int edges = 0;                                 ///< number of lines with an edge, at the finest level
  int blank = 0;                                 ///< number of lines without one
  int covered = 0;                               ///< number of silhouette points behind nearer depth
};

/// Registers the model from a start: at each of a few levels, from coarse to fine, lines and pairs are found and the
/// sum of their normal equations and of the regularisation is solved twice. Depth: point to plane (build_equations);
/// colours: region_equations; texture: texture_equations. Depth or colours suffice.
JointResult register_jointly(const ObjectObservation& observation, const JointStart& start,
                             const JointSettings& settings, const RegistrationSettings& registration);

/// Returns the part of a rotation about the model's centre that was observed, as a factor: its information over the sum
/// of that and of a step's regularisation. The factor is the identity where all of the rotation is known and 0 where
/// nothing is. `radius` is the model's.
Eigen::Matrix3d observed_rotation(const Matrix6d& information, double radius, const JointSettings& settings);

}  // namespace houghstream
