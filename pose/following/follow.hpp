#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/base/settings_fields.hpp"
#include "pipeline/types/frame.hpp"
#include "pipeline/types/object_pose.hpp"
#include "pose/following/joint_registration.hpp"
#include "pose/pose_estimator.hpp"

namespace houghstream {

/// How an object is found again in the next frame from where it is expected, without a detection. Between two frames it
/// moves by little: few points and steps of registration do.
struct FollowSettings {
  JointSettings joint;
  double max_jump_m = 0.04;  ///< of the middle, from where it was expected: what ended farther away is something else

  int min_edges = 40;  ///< lines of the silhouette by which a pose is measured where there is no depth

  // The texture turns a round thing back, which depth alone lets drift.
  double refine_step_deg = 2.0;
  double refine_step_m = 0.002;
  int refine_rounds = 4;
  int refine_points = 250;

  float max_occluded_fraction = 0.5F;     ///< of the rendered pixels, behind something: it is hidden rather than gone
  float max_free_space_violation = 0.3F;  ///< of the others, seen through: it is gone even so
};

template <typename Visit>
void fields(const FollowSettings& /*settings*/, const Visit& visit) {
  using S = FollowSettings;
  visit(group("joint", &S::joint));
  visit(number("max_jump_m", &S::max_jump_m, 0, 10, "m"));
  visit(number("min_edges", &S::min_edges, 1, 100000));
  visit(number("refine_step_deg", &S::refine_step_deg, 0, 180, "degrees"));
  visit(number("refine_step_m", &S::refine_step_m, 0, 1, "m"));
  visit(number("refine_rounds", &S::refine_rounds, 0, 1000));
  visit(number("refine_points", &S::refine_points, 1, 100000));
  visit(number("max_occluded_fraction", &S::max_occluded_fraction, 0, 1));
  visit(number("max_free_space_violation", &S::max_free_space_violation, 0, 1));
}

/// An object that was posed before, and where it may be in a frame.
struct ExpectedObject {
  int class_id = 0;
  std::string class_name;
  float score = 0.0F;                            ///< of the detections that it was found by
  std::vector<Eigen::Isometry3d> initial_poses;  ///< T_camera_object, the likeliest first; at least one
  bool refine_by_texture = false;                ///< its texture may move it a little too, at some cost
  bool is_lost = false;                          ///< it is looked for as far away as a detection's pose is
  bool check_occlusion = true;           ///< whether it is hidden where it is expected first: that renders it once more
  std::optional<Verification> verified;  ///< of an earlier frame: its outline is taken for this one's
  float texture_probability = 1.0F;  ///< PoseEvidence::texture_probability of the detection's pose that it goes on from
  ChromaMap camera_colours = {};     ///< by which its colours are judged
  float shape_quality = 0.0F;        ///< of its last pose for which depth spoke
  FollowedAppearance appearance;     ///< learnt in earlier frames
  DepthLag depth_lag;                ///< as JointStart has it
};

/// What came of it.
struct FollowedPose {
  ObjectPose pose;  ///< without a detection; its status says why where there is none, its residual is NaN then
  Eigen::Isometry3d T_camera_object = Eigen::Isometry3d::Identity();  ///< where the best attempt ended, withheld or not
  std::optional<Verification> verified;                               ///< of the last rendering
  bool has_depth = false;                                             ///< that it was judged by
  bool is_refined = false;                       ///< its texture has moved it (ExpectedObject::refine_by_texture)
  Matrix6d information = Matrix6d::Zero();       ///< JointResult::information of that attempt
  std::shared_ptr<const Silhouette> silhouette;  ///< that it used last, or nothing
};

/// Finds objects that were posed in earlier frames in this one, in their order, without detections, on
/// PoseSettings::threads threads. Registers the model from each start in turn until the evidence suffices, to depth and
/// to the edges of its colours (joint_registration.hpp), then verified as any pose is. Where no depth is measured the
/// edges alone carry the pose on, with the quality that it had less what they leave unexplained. Rendering
/// the model costs most: with an outline of an earlier frame, points of the view take its place as long as they
/// suffice. What is withheld has always been rendered. Where nothing suffices and the object is hidden where it was
/// expected first, its status is kOccluded (ExpectedObject::check_occlusion). Of a class without a model it is
/// kNoModel. Throws InputError for a frame that is none.
std::vector<FollowedPose> follow_objects(const PoseEstimator& estimator, const FollowSettings& settings,
                                         const RgbdFrame& frame, const std::vector<ExpectedObject>& expected);

}  // namespace houghstream
