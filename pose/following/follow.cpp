#include "pose/following/follow.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pipeline/base/parallel.hpp"
#include "pose/model/angles.hpp"
#include "pose/registration/rotation_search.hpp"
#include "pose/seen/depth_score.hpp"
#include "pose/verification/pose_decision.hpp"

namespace houghstream {
namespace {

struct FollowerInput {
  const PoseSettings& pose;
  const FollowSettings& follow;
};

Eigen::Vector3d middle_of(const ObjectModel& model, const Eigen::Isometry3d& T_camera_object) {
  return T_camera_object * model.centre.cast<double>();
}

/// Returns the box about the points that should be visible; it is empty where none is.
cv::Rect2f expected_box(const RgbdFrame& frame, const ObjectModel& model, const Eigen::Isometry3d& T_camera_object) {
  constexpr int kPoints = 150;
  const ProjectedView projected = project_view(frame, model, T_camera_object, kPoints);
  cv::Rect2f box;
  for (std::size_t i = 0; i < projected.points.size(); ++i) {
    const Eigen::Vector3f point = projected.T * projected.view.points[i];
    if (!(point.z() > 0.0F)) continue;
    const Eigen::Vector2f pixel = frame.camera.project_single(point);
    const cv::Rect2f pixel_box(pixel.x(), pixel.y(), 1.0F, 1.0F);
    box = box.area() > 0.0F ? box | pixel_box : pixel_box;
  }
  return box;
}

/// Observes the depth where the object is expected. Its colours, which take longer, follow by observe_colours().
ObjectObservation observe_expected(const FrameContext& frame, const ObjectModel& model,
                                   const Eigen::Isometry3d& T_camera_object, const PoseSettings& settings) {
  Detection expected;
  expected.box_px = expected_box(frame.frame, model, T_camera_object);
  expected.centre_camera = T_camera_object.cast<float>() * model.vote_centre;
  ObjectObservation observation{frame.frame, model};
  observation.centre_camera = expected.centre_camera;
  observation.noise = frame.noise;
  observation.region = find_region(frame.frame, expected, model, settings.region);
  return observation;
}

void observe_colours(const FrameContext& frame, ObjectObservation& observation) {
  if (observation.colours.lab.empty())
    observation.colours = lab_region(frame.frame, observation.region.box_px, frame.tone);
}

bool has_depth(const ObjectObservation& observation, const FollowerInput& input) {
  return observation.region.points >= input.pose.region.min_points;
}

/// Returns whether nothing but colours can show the object: it should be in the image, and no depth is measured there,
/// at whatever distance.
bool is_without_depth(const ObjectObservation& observation, const FollowerInput& input) {
  if (observation.region.box_px.empty()) return false;
  const cv::Mat part = observation.frame.depth(observation.region.box_px);
  // Counts measured pixels: NaN differs from itself.
  return cv::countNonZero(part == part) < input.pose.region.min_points;
}

/// Returns the refinement that moves the pose a little by texture, where depth and silhouette leave it free.
RefinePose texture_refinement(const ObjectObservation& observation, const FollowerInput& input) {
  return [&](const Eigen::Isometry3d& T_camera_object) {
    const FollowSettings& follow = input.follow;
    const HillClimb hill_climb{follow.refine_step_deg * kRadPerDeg, follow.refine_step_m, follow.refine_rounds,
                               follow.refine_points};
    const DepthTolerance tolerance{input.pose.verification.tolerance_m, observation.noise};
    return hill_climb_pose(observation, T_camera_object, hill_climb, tolerance).T_camera_object;
  };
}

JointResult register_near(const ObjectObservation& observation, const Eigen::Isometry3d& start,
                          const ExpectedObject& expected, const FollowerInput& input) {
  const RegistrationSettings& registration = input.pose.registration;
  JointStart joint;
  joint.T_camera_object = start;
  joint.appearance = expected.appearance;
  joint.depth_lag = expected.depth_lag;
  int iterations = 0;
  if (expected.is_lost) {
    const RegistrationResult near =
        register_coarsely(observation, start, correspondence_distances(observation, registration).start, registration);
    joint.T_camera_object = near.T_camera_object;
    iterations = near.iterations;
  }
  if (expected.refine_by_texture && has_depth(observation, input))
    joint.refine_by_texture = texture_refinement(observation, input);
  JointResult result = register_jointly(observation, joint, input.follow.joint, registration);
  result.registration.iterations += iterations;
  return result;
}

/// Decides on the pose of an object that was reported before. Where there is the outline of an earlier frame, points of
/// the view are compared with the depth, and an object that stands is judged by the colours that it had then; where
/// there is none, or they do not suffice, the model is rendered and its colours are compared.
void decide_by_depth(const FrameContext& frame, const ExpectedObject& expected, const FollowerInput& input,
                     ObjectObservation& observation, FollowedPose& followed) {
  const PoseSettings& settings = input.pose;
  const DepthTolerance tolerance{settings.verification.tolerance_m, observation.noise};
  const QualitySettings& quality = class_quality_of(settings, followed.pose.class_name);
  const Eigen::Isometry3d& T = followed.T_camera_object;
  const ProjectedView projected = project_view(observation.frame, observation.model, T, settings.verification.points);
  followed.pose.camera_colours = expected.camera_colours;
  const auto compare_here = [&] {
    observe_colours(frame, observation);
    followed.colours = {compare_texture(observation, projected, tolerance), T};
  };
  const auto decide = [&](const Verification& depth) {
    PoseEvidence evidence{expected.score, depth, followed.colours->comparison, expected.texture_probability};
    bring_to_camera(expected.camera_colours, evidence);
    followed.pose.chroma = chroma_pair(followed.pose.class_name, evidence, quality);
    decide_status(evidence, T, true, quality, followed.pose);
  };
  const bool reuses_colours =
      expected.verified && expected.colours && is_same_place(observation.model, expected.colours->T_camera_object, T);
  followed.colours = expected.colours;
  if (!reuses_colours) compare_here();
  if (expected.verified) {
    Verification depth = verify_projected_view(projected, tolerance);
    depth.boundary_samples = expected.verified->boundary_samples;
    depth.boundary_continuations = expected.verified->boundary_continuations;
    followed.verified = expected.verified;
    decide(depth);
    // The outline of an earlier frame cannot show where the camera sees through the object in this one.
    const auto judged = static_cast<float>(depth.depth_inliers + depth.free_space_violations);
    const bool is_present =
        static_cast<float>(depth.free_space_violations) <= input.follow.max_free_space_violation * judged;
    if (has_pose(followed.pose.status) && is_present) return;
    followed.pose.T_camera_object.reset();
  }
  if (reuses_colours) compare_here();
  followed.verified = verify_pose(observation.frame, observation.model.mesh, T, tolerance, &observation.colours);
  decide(*followed.verified);
}

/// Decides on the pose where no depth is measured: its quality is the last one times the fraction of the silhouette's
/// lines that have an edge.
void decide_by_colours(const ExpectedObject& expected, const JointResult& result, const FollowerInput& input,
                       FollowedPose& followed) {
  ObjectPose& pose = followed.pose;
  const int judged = result.edges + result.blank;
  const float explained = judged == 0 ? 0.0F : static_cast<float>(result.edges) / static_cast<float>(judged);
  pose.shape_quality = expected.shape_quality * explained;
  pose.quality = pose.shape_quality * expected.texture_probability;
  followed.verified = expected.verified;
  const float minimum = class_quality_of(input.pose, pose.class_name).min_quality;
  pose.status = PoseStatus::kTooFewPoints;
  if (pose.shape_quality < minimum) return;
  pose.status = pose.quality >= minimum ? PoseStatus::kValid : PoseStatus::kValidUpToSymmetry;
  pose.T_camera_object = followed.T_camera_object;
}

/// Returns the result for an object that has not been measured in this frame yet.
FollowedPose make_unposed(const ExpectedObject& expected) {
  FollowedPose followed;
  followed.pose.class_id = expected.class_id;
  followed.pose.class_name = expected.class_name;
  followed.pose.detection_score = expected.score;
  followed.pose.residual = std::numeric_limits<float>::quiet_NaN();
  followed.T_camera_object = expected.initial_poses.front();
  return followed;
}

FollowedPose follow_from(const FrameContext& frame, const ObjectModel& model, const ExpectedObject& expected,
                         const Eigen::Isometry3d& start, const FollowerInput& input) {
  const PoseSettings& settings = input.pose;
  FollowedPose followed = make_unposed(expected);
  ObjectPose& pose = followed.pose;
  followed.T_camera_object = start;
  ObjectObservation observation = observe_expected(frame, model, start, settings);
  followed.has_depth = has_depth(observation, input);
  if (followed.has_depth && expected.refine_by_texture) observe_colours(frame, observation);
  if (!followed.has_depth && !(is_without_depth(observation, input) && expected.appearance.colours)) {
    pose.status = PoseStatus::kTooFewPoints;
    return followed;
  }
  const JointResult result = register_near(observation, start, expected, input);
  const RegistrationResult& registration = result.registration;
  copy_registration_evidence(registration, pose);
  followed.silhouette = result.silhouette;
  followed.information = result.information;
  followed.lag = result.lag;
  followed.is_refined = expected.refine_by_texture && followed.has_depth;
  const double jump_m = (middle_of(model, registration.T_camera_object) - middle_of(model, start)).norm();
  const double max_m = expected.is_lost ? settings.registration.max_shift_m : input.follow.max_jump_m;
  const bool is_measured = followed.has_depth ? registration.inliers > 0 : result.edges >= input.follow.min_edges;
  if (!is_measured || !(jump_m <= max_m)) {
    pose.status = followed.has_depth ? PoseStatus::kNotConverged : PoseStatus::kTooFewPoints;
    return followed;
  }
  followed.T_camera_object = registration.T_camera_object;
  if (followed.has_depth) {
    decide_by_depth(frame, expected, input, observation, followed);
  } else {
    decide_by_colours(expected, result, input, followed);
  }
  return followed;
}

/// Returns whether something occludes the object, and the rest of it shows no free-space violation.
bool is_occluded(const FrameContext& frame, const ObjectModel& model, const Eigen::Isometry3d& T_camera_object,
                 const FollowerInput& input) {
  const DepthTolerance tolerance{input.pose.verification.tolerance_m, frame.noise};
  const Verification verification = verify_pose(frame.frame, model.mesh, T_camera_object, tolerance);
  const auto rendered = static_cast<float>(verification.rendered);
  const auto occluded = static_cast<float>(verification.occluded);
  return occluded > input.follow.max_occluded_fraction * rendered &&
         static_cast<float>(verification.free_space_violations) <=
             input.follow.max_free_space_violation * (rendered - occluded);
}

FollowedPose follow_object(const FrameContext& frame, const ObjectModel& model, const ExpectedObject& expected,
                           const FollowerInput& input) {
  FollowedPose best;
  for (std::size_t i = 0; i < expected.initial_poses.size(); ++i) {
    FollowedPose followed = follow_from(frame, model, expected, expected.initial_poses[i], input);
    if (i == 0 || followed.pose.shape_quality > best.pose.shape_quality) best = std::move(followed);
    if (has_pose(best.pose.status)) return best;
  }
  if (expected.check_occlusion && is_occluded(frame, model, expected.initial_poses.front(), input))
    best.pose.status = PoseStatus::kOccluded;
  return best;
}

}  // namespace

bool is_same_place(const ObjectModel& model, const Eigen::Isometry3d& T_before, const Eigen::Isometry3d& T_after) {
  constexpr double kMoved_m = 0.002;
  const double angle = Eigen::AngleAxisd(T_before.linear().transpose() * T_after.linear()).angle();
  const double shift_m = (middle_of(model, T_after) - middle_of(model, T_before)).norm();
  return shift_m + angle * static_cast<double>(model.radius) <= kMoved_m;
}

std::vector<FollowedPose> follow_objects(const PoseEstimator& estimator, const FollowSettings& settings,
                                         const RgbdFrame& frame, const std::vector<ExpectedObject>& expected) {
  check_frame(frame, "pose estimation");
  const FollowerInput input{estimator.settings(), settings};
  const FrameContext context = make_frame_context(frame, input.pose.region, input.pose.noise);
  std::vector<FollowedPose> followed(expected.size());
  parallel_for(input.pose.threads, static_cast<int>(expected.size()), [&](int i) {
    const ExpectedObject& object = expected[i];
    const auto model = estimator.models().find(object.class_name);
    if (model != estimator.models().end()) {
      followed[i] = follow_object(context, model->second, object, input);
    } else {
      followed[i] = make_unposed(object);
      followed[i].pose.status = PoseStatus::kNoModel;
    }
  });
  return followed;
}

}  // namespace houghstream
