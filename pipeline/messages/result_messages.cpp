#include <algorithm>
#include <cmath>
#include <houghstream/stage_time_t.hpp>
#include <limits>

#include "pipeline/base/checks.hpp"
#include "pipeline/messages/messages.hpp"
#include "pipeline/messages/wire_values.hpp"

namespace houghstream {
namespace {

bool is_fraction(float value) {
  return value >= 0.0F && value <= 1.0F;
}

template <typename Message>
void set_stages(Message& message, const std::vector<StageTime>& stages) {
  for (const StageTime& stage : stages) {
    stage_time_t entry;
    entry.stage = stage.stage;
    entry.duration_us = stage.duration_us;
    message.stages.push_back(std::move(entry));
  }
  message.n_stages = static_cast<std::int32_t>(message.stages.size());
}

std::vector<StageTime> stages_from(const std::vector<stage_time_t>& stages) {
  std::vector<StageTime> out;
  out.reserve(stages.size());
  for (const stage_time_t& stage : stages) out.push_back({stage.stage, stage.duration_us});
  return out;
}

detection_t detection_to_message(const Detection& detection) {
  detection_t message{};
  message.class_id = detection.class_id;
  message.class_name = detection.class_name;
  message.score = detection.score;
  message.reported = detection.reported ? 1 : 0;
  message.box_x = detection.box_px.x;
  message.box_y = detection.box_px.y;
  message.box_width = detection.box_px.width;
  message.box_height = detection.box_px.height;
  std::copy_n(detection.centre_camera.data(), 3, message.centre_camera);
  message.vote_weight = detection.vote_weight;
  message.n_votes_total = detection.vote_count;
  const std::size_t votes = std::min<std::size_t>(detection.rotations.size(), detection_t::MAX_VOTES);
  for (std::size_t i = 0; i < votes; ++i) {
    const Eigen::Quaternionf& q = detection.rotations[i].R_camera_object;
    message.vote_quat.push_back({q.w(), q.x(), q.y(), q.z()});
    message.vote_quat_weight.push_back(detection.rotations[i].weight);
  }
  message.n_votes = static_cast<std::int32_t>(votes);
  return message;
}

RotationVote vote_from(const std::vector<float>& wxyz, float weight) {
  require(wxyz.size() == 4, "a vote's rotation of {} numbers, expected 4", wxyz.size());
  const Eigen::Quaternionf q(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
  require(std::abs(q.norm() - 1.0F) < kUnitTolerance, "a vote's quaternion of length {}, expected 1", q.norm());
  require(std::isfinite(weight) && weight >= 0.0F, "a vote of weight {}, expected 0 or more", weight);
  return {q, weight};
}

Detection detection_from_message(const detection_t& message) {
  require(message.class_id != detection_t::INVALID_CLASS && !message.class_name.empty(),
          "detection of class {} '{}', expected a class with a name", message.class_id, message.class_name);
  const cv::Rect2f box(message.box_x, message.box_y, message.box_width, message.box_height);
  check_wire_box(box, message.class_name + ": box");
  const Eigen::Vector3f centre(message.centre_camera);
  const bool has_centre = centre.allFinite() && static_cast<double>(centre.cwiseAbs().maxCoeff()) <= kMaxDistanceM;
  require(has_centre || centre.array().isNaN().all(), "{}: centre ({}, {}, {}), expected metres within {}, or NaN",
          message.class_name, centre.x(), centre.y(), centre.z(), kMaxDistanceM);
  require(std::isfinite(message.score) && std::isfinite(message.vote_weight), "{}: score {} and vote weight {}",
          message.class_name, message.score, message.vote_weight);
  Detection out;
  out.class_id = message.class_id;
  out.class_name = message.class_name;
  out.score = message.score;
  out.reported = message.reported != 0;
  out.box_px = box;
  out.centre_camera = centre;
  out.vote_weight = message.vote_weight;
  out.vote_count = message.n_votes_total;
  require(message.vote_quat.size() <= detection_t::MAX_VOTES, "{}: {} rotations, expected at most {}",
          message.class_name, message.vote_quat.size(), int{detection_t::MAX_VOTES});
  for (std::size_t i = 0; i < message.vote_quat.size(); ++i) {
    out.rotations.push_back(vote_from(message.vote_quat[i], message.vote_quat_weight.at(i)));
  }
  return out;
}

object_pose_t pose_to_message(const ObjectPose& pose) {
  object_pose_t message{};
  message.class_id = pose.class_id;
  message.class_name = pose.class_name;
  message.detection_score = pose.detection_score;
  message.detection_index = pose.detection_index;
  message.status = static_cast<std::int8_t>(pose.status);
  std::fill_n(message.trans, 3, std::numeric_limits<double>::quiet_NaN());
  std::fill_n(message.quat, 4, std::numeric_limits<double>::quiet_NaN());
  if (pose.T_camera_object) {
    const rigid_transform_t transform = to_message(0, *pose.T_camera_object);
    std::copy_n(transform.trans, 3, message.trans);
    std::copy_n(transform.quat, 4, message.quat);
  }
  message.converged = pose.converged ? 1 : 0;
  message.iterations = pose.iterations;
  message.n_inliers = pose.inliers;
  message.inlier_fraction = pose.inlier_fraction;
  message.residual_m = pose.residual;
  message.visible_fraction = pose.visible_fraction;
  message.free_space_violation = pose.free_space_violation;
  message.quality = pose.quality;
  return message;
}

ObjectPose pose_from_message(const object_pose_t& message) {
  require(message.status > object_pose_t::INVALID && message.status <= object_pose_t::VALID_UP_TO_SYMMETRY,
          "{}: pose status {}, expected {} to {}", message.class_name, message.status, object_pose_t::VALID,
          object_pose_t::VALID_UP_TO_SYMMETRY);
  const bool are_shares = is_fraction(message.inlier_fraction) && is_fraction(message.visible_fraction) &&
                          is_fraction(message.free_space_violation) && is_fraction(message.quality);
  require(are_shares, "{}: shares {}, {}, {} and {}, expected 0 to 1", message.class_name, message.inlier_fraction,
          message.visible_fraction, message.free_space_violation, message.quality);
  ObjectPose out;
  out.class_id = message.class_id;
  out.class_name = message.class_name;
  out.detection_score = message.detection_score;
  out.detection_index = message.detection_index;
  out.status = static_cast<PoseStatus>(message.status);
  if (has_pose(out.status))
    out.T_camera_object = pose_from_wire(message.trans, message.quat, message.class_name + ": valid pose");
  out.converged = message.converged != 0;
  out.iterations = message.iterations;
  out.inliers = message.n_inliers;
  out.inlier_fraction = message.inlier_fraction;
  out.residual = message.residual_m;
  out.visible_fraction = message.visible_fraction;
  out.free_space_violation = message.free_space_violation;
  out.quality = message.quality;
  out.shape_quality = message.quality;
  return out;
}

}  // namespace

detections_t to_message(const Detections& detections) {
  detections_t message{};
  message.utime = detections.frame.utime;
  message.source_channel = detections.frame.channel;
  for (const Detection& detection : detections.detections) {
    message.detections.push_back(detection_to_message(detection));
  }
  message.n_detections = static_cast<std::int32_t>(message.detections.size());
  set_stages(message, detections.stages);
  return message;
}

Detections detections_from_message(const detections_t& message) {
  try {
    Detections out;
    out.frame = {message.source_channel, message.utime};
    for (const detection_t& detection : message.detections) out.detections.push_back(detection_from_message(detection));
    out.stages = stages_from(message.stages);
    return out;
  } catch (const InputError& error) {
    fail("detections of frame {}: {}", to_string(FrameId{message.source_channel, message.utime}), error.what());
  }
}

pose_probabilities_t probabilities_to_message(const ObjectPoses& poses) {
  pose_probabilities_t message{};
  message.utime = poses.frame.utime;
  message.source_channel = poses.frame.channel;
  message.n_poses = static_cast<std::int32_t>(poses.poses.size());
  for (const ObjectPose& pose : poses.poses) {
    message.right.push_back(pose.quality);
    message.right_up_to_symmetry.push_back(pose.shape_quality);
  }
  return message;
}

bool apply_probabilities(const pose_probabilities_t& message, ObjectPoses& poses) {
  if (poses.frame != FrameId{message.source_channel, message.utime} || message.right.size() != poses.poses.size())
    return false;
  for (std::size_t i = 0; i < poses.poses.size(); ++i) {
    if (message.right[i] != poses.poses[i].quality) return false;
  }
  for (std::size_t i = 0; i < poses.poses.size(); ++i) {
    const float shape_quality = message.right_up_to_symmetry[i];
    require(is_fraction(shape_quality) && shape_quality >= message.right[i],
            "probabilities of the poses of frame {}: {} up to symmetry, expected {} to 1", to_string(poses.frame),
            shape_quality, message.right[i]);
    poses.poses[i].shape_quality = shape_quality;
  }
  return true;
}

camera_colours_t to_message(const CameraChroma& colours) {
  const auto number = [](double value) { return static_cast<float>(value); };
  camera_colours_t message{};
  message.utime = colours.frame.utime;
  message.source_channel = colours.frame.channel;
  message.n_objects = static_cast<std::int32_t>(colours.objects.size());
  for (const ChromaPair& pair : colours.objects) {
    message.class_name.push_back(pair.class_name);
    message.model_a.push_back(number(pair.model.x()));
    message.model_b.push_back(number(pair.model.y()));
    message.measured_a.push_back(number(pair.measured.x()));
    message.measured_b.push_back(number(pair.measured.y()));
    message.lightness.push_back(number(pair.lightness));
    message.probability.push_back(number(pair.probability));
  }
  const ChromaMap map = fit_chroma_map(colours.objects);
  for (int i = 0; i < 4; ++i) message.gain[i / 2][i % 2] = number(map.parameters()(i));
  for (int i = 0; i < 2; ++i) message.cast[i] = number(map.parameters()(4 + i));
  message.sigma = number(map.sigma());
  return message;
}

CameraChroma camera_colours_from_message(const camera_colours_t& message) {
  CameraChroma colours;
  colours.frame = {message.source_channel, message.utime};
  for (std::size_t i = 0; i < message.class_name.size(); ++i) {
    ChromaPair& pair = colours.objects.emplace_back();
    pair.class_name = message.class_name[i];
    pair.model = {message.model_a[i], message.model_b[i]};
    pair.measured = {message.measured_a[i], message.measured_b[i]};
    pair.lightness = message.lightness[i];
    pair.probability = message.probability[i];
    require(is_chroma_pair(pair),
            "colours of camera {}: '{}' has ({} {}), measured ({} {}) at lightness {} with probability {}, expected a* "
            "and b* of -130 to 130, 0 to 100 and 0 to 1",
            colours.frame.channel, pair.class_name, pair.model.x(), pair.model.y(), pair.measured.x(),
            pair.measured.y(), pair.lightness, pair.probability);
  }
  return colours;
}

camera_timing_t to_message(const CameraTiming& timing) {
  camera_timing_t message{};
  message.utime = timing.frame.utime;
  message.source_channel = timing.frame.channel;
  message.depth_lag_s = static_cast<float>(timing.depth_lag_s);
  message.depth_lag_sigma_s = static_cast<float>(timing.sigma_s);
  return message;
}

CameraTiming camera_timing_from_message(const camera_timing_t& message) {
  constexpr float kMaxLag = 10.0F;  // seconds; no camera waits so long
  require(std::abs(message.depth_lag_s) <= kMaxLag && message.depth_lag_sigma_s >= 0.0F &&
              message.depth_lag_sigma_s <= kMaxLag,  // false for NaN
          "timing of camera {}: a lag of {} s with a deviation of {} s, expected -{} to {} s and 0 to {} s",
          message.source_channel, message.depth_lag_s, message.depth_lag_sigma_s, kMaxLag, kMaxLag, kMaxLag);
  return {{message.source_channel, message.utime}, message.depth_lag_s, message.depth_lag_sigma_s};
}

object_poses_t to_message(const ObjectPoses& poses) {
  object_poses_t message{};
  message.utime = poses.frame.utime;
  message.source_channel = poses.frame.channel;
  for (const ObjectPose& pose : poses.poses) message.poses.push_back(pose_to_message(pose));
  message.n_poses = static_cast<std::int32_t>(message.poses.size());
  set_stages(message, poses.stages);
  return message;
}

ObjectPoses poses_from_message(const object_poses_t& message) {
  try {
    ObjectPoses out;
    out.frame = {message.source_channel, message.utime};
    for (const object_pose_t& pose : message.poses) out.poses.push_back(pose_from_message(pose));
    out.stages = stages_from(message.stages);
    return out;
  } catch (const InputError& error) {
    fail("poses of frame {}: {}", to_string(FrameId{message.source_channel, message.utime}), error.what());
  }
}

rigid_transform_t to_message(std::int64_t utime, const Eigen::Isometry3d& T_camera_object) {
  rigid_transform_t message{};
  message.utime = utime;
  const Eigen::Quaterniond q(T_camera_object.linear());
  std::copy_n(T_camera_object.translation().data(), 3, message.trans);
  const double wxyz[4] = {q.w(), q.x(), q.y(), q.z()};
  std::copy_n(wxyz, 4, message.quat);
  return message;
}

}  // namespace houghstream
