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
#include "pose/seen/colour_score.hpp"

namespace houghstream {

/// Settings by which an object is found again in the next frame from its predicted pose, without a detection. It moves
/// little between two frames, so that few points and few steps of registration suffice.
struct FollowSettings {
  JointSettings joint;
  /// Distance of the middle from its predicted place, beyond which the result is another object.
  double max_jump_m = 0.04;

  int min_edges = 40;  ///< number of silhouette lines that measure a pose where there is no depth

  // The texture corrects the rotation of a round object, which depth alone lets drift.
  double refine_step_deg = 2.0;
  double refine_step_m = 0.002;
  int refine_rounds = 4;
  int refine_points = 250;

  /// Fraction of the rendered pixels behind a nearer surface: above it the object is hidden, not gone.
  float max_occluded_fraction = 0.5F;
  /// Fraction of the others that shows free space: above it the object is gone even so.
  float max_free_space_violation = 0.3F;
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

/// Colours of an object beside its model's, as one frame showed them.
struct ComparedColours {
  std::optional<ColourComparison> comparison;                         ///< nothing where there was too little to compare
  Eigen::Isometry3d T_camera_object = Eigen::Isometry3d::Identity();  ///< pose at which they were compared, metres
};

/// An object that had a pose in an earlier frame, with its predicted poses in this one.
struct ExpectedObject {
  int class_id = 0;
  std::string class_name;
  float score = 0.0F;                            ///< score of the detections that found it
  std::vector<Eigen::Isometry3d> initial_poses;  ///< T_camera_object, the likeliest first; at least one
  bool refine_by_texture = false;                ///< whether its texture may move the pose a little too, at some cost
  bool is_lost = false;                          ///< whether it is searched for within the reach of a detection's pose
  /// Tests for occlusion at the first predicted pose, which costs one more rendering.
  bool check_occlusion = true;
  std::optional<Verification> verified;  ///< result of an earlier frame, whose outline serves for this one
  /// Colours of an earlier frame, which serve for this one where the object has not moved since.
  std::optional<ComparedColours> colours;
  float texture_probability = 1.0F;  ///< PoseEvidence::texture_probability of the detection's pose that it continues
  ChromaMap camera_colours = {};     ///< map from taught to measured colours, by which its colours are judged
  float shape_quality = 0.0F;        ///< shape quality of its last pose that was judged by depth
  FollowedAppearance appearance;     ///< appearance that earlier frames have taught
  DepthLag depth_lag;                ///< lag between depth and colours, as in JointStart
};

/// Result of following one object in one frame.
struct FollowedPose {
  /// Pose without a detection; its status names the reason where there is none, its residual is NaN then.
  ObjectPose pose;
  /// Place where the best attempt ended, withheld or not.
  Eigen::Isometry3d T_camera_object = Eigen::Isometry3d::Identity();
  std::optional<Verification> verified;     ///< verification by the last rendering
  std::optional<ComparedColours> colours;   ///< colours by which it was judged, of this frame or of an earlier one
  bool has_depth = false;                   ///< whether it was judged by depth
  bool is_refined = false;                  ///< whether its texture has moved it (ExpectedObject::refine_by_texture)
  Matrix6d information = Matrix6d::Zero();  ///< JointResult::information of that attempt
  LagEvidence lag;                          ///< JointResult::lag of that attempt
  std::shared_ptr<const Silhouette> silhouette;  ///< silhouette that it used last, or null
};

/// Returns whether no point of the model moves between two poses by more than a pixel or two (2 mm): what the image
/// showed of it at the one it shows at the other.
bool is_same_place(const ObjectModel& model, const Eigen::Isometry3d& T_before, const Eigen::Isometry3d& T_after);

/// Finds objects that were posed in earlier frames in this one, in their order, without detections, on
/// PoseSettings::threads threads. Registers the model from each start in turn, to depth and to the edges of its colours
/// (joint_registration.hpp), and verifies the result as any pose is verified, until the evidence suffices. Where no
/// depth is measured the edges alone determine the pose, and its quality is the last one times the fraction of the
/// silhouette's lines that have an edge. Rendering the model and comparing its colours cost most: with an outline of an
/// earlier frame, points of the view take its place as long as they suffice, and the colours of that frame serve as
/// long as the object stands before the camera. A rejected pose has always been rendered and compared in its own frame.
/// Where nothing suffices and the object is occluded where it was expected first, its status is kOccluded
/// (ExpectedObject::check_occlusion). The status of a class without a model is kNoModel. Throws InputError for an
/// invalid frame.
std::vector<FollowedPose> follow_objects(const PoseEstimator& estimator, const FollowSettings& settings,
                                         const RgbdFrame& frame, const std::vector<ExpectedObject>& expected);

}  // namespace houghstream
