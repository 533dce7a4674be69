#include "pose/tracks/track.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/logit.hpp"
#include "pose/model/symmetry.hpp"
#include "pose/motion/pose_covariance.hpp"
#include "pose/motion/twist.hpp"

namespace houghstream::tracks {
namespace {

constexpr std::size_t kMaxHypotheses = 3;
constexpr double kMaxWeight = 6.0;
constexpr double kWeightDecay_s = 3.0;

}  // namespace

double quality_logit(double quality) {
  constexpr double kMargin = 0.02;
  return logit(quality, kMargin);
}

TrackModels make_track_models(std::map<std::string, Mesh> meshes, const std::map<std::string, Symmetries>& symmetries) {
  TrackModels models;
  for (auto& named : meshes) {
    const std::string& name = named.first;
    Mesh& mesh = named.second;
    require(!mesh.triangles.empty(), "model {}: no triangles, expected a mesh", name);
    TrackModel model;
    const Eigen::AlignedBox3f bounds = mesh_bounds(mesh);
    model.bounds = bounds.cast<double>();
    model.centre = bounds.center().cast<double>();
    model.box_radius_m = 0.5 * static_cast<double>(bounds.sizes().norm());
    if (const auto known = symmetries.find(name); known != symmetries.end()) model.symmetries = known->second;
    model.mesh = std::move(mesh);
    models.emplace(name, std::move(model));
  }
  return models;
}

Eigen::Vector3d centre_of(const TrackModels& models, const std::string& name) {
  const auto model = models.find(name);
  return model == models.end() ? Eigen::Vector3d(0.0, 0.0, 0.0) : model->second.centre;
}

double radius_of(const TrackModels& models, const std::string& name) {
  constexpr double kDefaultRadius_m = 0.07;
  const auto model = models.find(name);
  return model == models.end() ? kDefaultRadius_m : model->second.box_radius_m;
}

const Symmetries& symmetries_of(const TrackModels& models, const std::string& name) {
  static const Symmetries none;
  const auto model = models.find(name);
  return model == models.end() ? none : model->second.symmetries;
}

ObjectPlacements place_objects(const WorldObjects& world, const TrackModels& models) {
  ObjectPlacements placed;
  placed.frame = world.frame;
  placed.world = world.world;
  placed.world_number = world.world_number;
  for (const TrackedObject& object : world.objects) {
    const auto model = models.find(object.class_name);
    if (model == models.end() || object.state == TrackState::kGone) continue;
    ObjectPlacement& place = placed.objects.emplace_back();
    place.track_id = object.track_id;
    place.class_name = object.class_name;
    place.T_world_box = object.T_world_object * Eigen::Translation3d(model->second.centre);
    place.box_size = model->second.bounds.sizes();
    for (const ObjectFrame& frame : model->second.frames)
      place.frames.push_back({frame.name, object.T_world_object * frame.T_object_frame});
  }
  return placed;
}

std::vector<PoseObservation> observe_poses(const ObjectPoses& poses, const Eigen::Isometry3d& T_world_camera,
                                           const TrackModels& models) {
  std::vector<PoseObservation> out;
  for (const ObjectPose& pose : poses.poses) {
    if (!pose.T_camera_object) continue;
    PoseObservation& observation = out.emplace_back();
    observation.frame = poses.frame;
    observation.class_id = pose.class_id;
    observation.class_name = pose.class_name;
    observation.quality = static_cast<double>(pose.quality);
    observation.measured.utime = poses.frame.utime;
    observation.measured.T_world_object = T_world_camera * *pose.T_camera_object;
    observation.measured.covariance = measured_pose_covariance(
        pose, T_world_camera, {centre_of(models, pose.class_name), radius_of(models, pose.class_name)});
  }
  return out;
}

PoseTrack::PoseTrack(const PoseObservation& first, const PoseTrackSettings& settings)
    : settings_(settings),
      hypotheses_{{MotionFilter(first.measured, settings.motion), quality_logit(first.quality)}},
      weights_utime_(first.frame.utime) {
  observers_[first.frame.channel].agreed_utime = first.frame.utime;
}

void PoseTrack::predict(std::int64_t utime) {
  for (Hypothesis& hypothesis : hypotheses_) hypothesis.filter.predict(utime);
}

void PoseTrack::update(const PoseObservation& pose, const Symmetries& symmetries, bool has_contrary_depth) {
  constexpr double kMinLead = 1.0;  // margin of log odds by which another hypothesis must lead
  const double passed = std::max(0.0, seconds_between(weights_utime_, pose.frame.utime));
  weights_utime_ = std::max(weights_utime_, pose.frame.utime);
  for (Hypothesis& hypothesis : hypotheses_) hypothesis.weight *= std::exp(-passed / kWeightDecay_s);
  const std::size_t index = hypothesis_for(pose.measured, symmetries);
  Hypothesis& hypothesis = hypotheses_[index];
  hypothesis.weight = std::min(kMaxWeight, hypothesis.weight + std::max(0.1, quality_logit(pose.quality)));
  PoseObservation nearest = pose;
  nearest.measured.T_world_object =
      nearest_equivalent(pose.measured.T_world_object, hypothesis.filter.T_world_object(), symmetries);
  hypothesis.filter.predict(pose.frame.utime);
  if (hypothesis.filter.moving()) {
    update_moving(nearest.measured, hypothesis);
  } else {
    update_static(nearest, has_contrary_depth, hypothesis);
  }
  if (hypothesis.weight > hypotheses_[best_].weight + kMinLead) best_ = index;
  if (hypothesis.filter.moving() && index == best_ && hypotheses_.size() > 1) {
    hypotheses_ = {hypothesis};  // hypotheses from before the motion are obsolete
    best_ = 0;
  }
}

// Returns the hypothesis that the measured rotation belongs to: the best where it fits, else the nearest, else a new
// one, which replaces the weakest.
std::size_t PoseTrack::hypothesis_for(const PoseMeasurement& measured, const Symmetries& symmetries) {
  std::optional<std::size_t> found;
  double nearest = settings_.same_rotation_rad;
  for (std::size_t i = 0; i < hypotheses_.size(); ++i) {
    const Eigen::Isometry3d& T = hypotheses_[i].filter.T_world_object();
    const double angle =
        local_coordinates_about_world(nearest_equivalent(measured.T_world_object, T, symmetries), T).tail<3>().norm();
    if (angle < settings_.same_rotation_rad && i == best_) return i;
    if (angle >= nearest) continue;
    nearest = angle;
    found = i;
  }
  if (found) return *found;
  if (hypotheses_.size() < kMaxHypotheses) {
    hypotheses_.push_back({MotionFilter(measured, settings_.motion), 0.0});
    return hypotheses_.size() - 1;
  }
  std::size_t weakest = best_ == 0 ? 1 : 0;
  for (std::size_t i = 0; i < hypotheses_.size(); ++i) {
    if (i != best_ && hypotheses_[i].weight < hypotheses_[weakest].weight) weakest = i;
  }
  hypotheses_[weakest] = {MotionFilter(measured, settings_.motion), 0.0};
  return weakest;
}

void PoseTrack::update_static(const PoseObservation& pose, bool has_contrary_depth, Hypothesis& hypothesis) {
  constexpr double kWindow_s = 0.4;
  constexpr std::size_t kMinPositions = 3;  // measurements outside the gate of its position
  constexpr std::size_t kMinRotations = 8;  // measurements whose rotation alone changed
  const Vector6 innovation =
      local_coordinates_about_world(pose.measured.T_world_object, hypothesis.filter.T_world_object());
  const Covariance6& covariance = pose.measured.covariance;
  const double place_gate =
      std::max(settings_.static_gate_m, 4.0 * std::sqrt(covariance.topLeftCorner<3, 3>().trace() / 3.0));
  const double rotation_gate = std::max(settings_.static_gate_rad, 4.0 * std::sqrt(covariance(5, 5)));
  const bool is_in_place = innovation.head<3>().norm() < place_gate;
  ObserverHistory& observer = observers_[pose.frame.channel];
  if (is_in_place && innovation.tail<3>().norm() < rotation_gate) {
    hypothesis.filter.update(pose.measured);
    observer.outside_gates.clear();
    observer.agreed_utime = pose.frame.utime;
    return;
  }
  observer.outside_gates.push_back(pose.measured);
  while (seconds_between(observer.outside_gates.front().utime, pose.frame.utime) > kWindow_s)
    observer.outside_gates.pop_front();
  const std::size_t min_count = is_in_place ? kMinRotations : has_contrary_depth ? 1 : kMinPositions;
  if (observer.outside_gates.size() < min_count || !can_trigger_motion(pose.frame.channel, pose.frame.utime)) return;
  const PoseMeasurement& first = observer.outside_gates.front();
  const double seconds = std::max(0.02, seconds_between(first.utime, pose.frame.utime));
  Vector6 motion = local_coordinates_about_world(pose.measured.T_world_object, first.T_world_object);
  // The first measurement may have been taken in another hypothesis' rotation. The object has not rotated then.
  if (motion.tail<3>().norm() > settings_.same_rotation_rad) motion.tail<3>().setZero();
  hypothesis.filter.start_moving(pose.measured, motion / seconds);
  recent_ = {pose.measured};
  observers_.clear();
  observers_[pose.frame.channel].agreed_utime = pose.frame.utime;
}

// A camera whose extrinsics are a little wrong always measures the object beside where the other cameras do. Therefore
// only a camera that has measured it within the gates, or the only camera that observes it, can trigger a motion.
bool PoseTrack::can_trigger_motion(const std::string& channel, std::int64_t utime) const {
  constexpr double kRecent_s = 0.5;
  if (observers_.at(channel).agreed_utime != 0) return true;
  return std::none_of(observers_.begin(), observers_.end(), [&](const auto& entry) {
    return entry.first != channel && seconds_between(entry.second.agreed_utime, utime) < kRecent_s;
  });
}

void PoseTrack::update_moving(const PoseMeasurement& measured, Hypothesis& hypothesis) {
  constexpr double kWindow_s = 0.4;
  constexpr double kMinWindow_s = 0.28;
  constexpr std::size_t kMinPoses = 6;
  // Another camera's frame may be a little older, so that its pose is predicted to the filter's time.
  const double late_s = std::min(settings_.motion.coast_s, seconds_between(measured.utime, hypothesis.filter.utime()));
  PoseMeasurement predicted = measured;
  if (late_s > 0.0)
    predicted.T_world_object = retract_about_world(measured.T_world_object, late_s * hypothesis.filter.velocity());
  hypothesis.filter.update(predicted);
  recent_.push_back(measured);
  while (seconds_between(recent_.front().utime, measured.utime) > kWindow_s) recent_.pop_front();
  if (recent_.size() < kMinPoses || seconds_between(recent_.front().utime, measured.utime) < kMinWindow_s) return;
  // Compares the mean of the earlier half with that of the later half; each is computed in the tangent space at the
  // middle pose.
  const Eigen::Isometry3d& T_middle = recent_[recent_.size() / 2].T_world_object;
  std::array<Vector6, 2> means = {Vector6::Zero(), Vector6::Zero()};
  const std::size_t half = recent_.size() / 2;
  for (std::size_t i = 0; i < 2 * half; ++i)
    means[i / half] += local_coordinates_about_world(recent_[i].T_world_object, T_middle) / static_cast<double>(half);
  const Vector6 half_difference = means[1] - means[0];
  if (half_difference.head<3>().norm() < settings_.rest_threshold_m &&
      half_difference.tail<3>().norm() < settings_.rest_threshold_rad) {
    hypothesis.filter.stop();
    recent_.clear();
  }
}

double PoseTrack::distance(const PoseMeasurement& measured, const Symmetries& symmetries,
                           const Eigen::Vector3d& centre) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Hypothesis& hypothesis : hypotheses_) {
    const Eigen::Isometry3d& T = hypothesis.filter.T_world_object();
    nearest =
        std::min(nearest, (nearest_equivalent(measured.T_world_object, T, symmetries) * centre - T * centre).norm());
  }
  return nearest;
}

double PoseTrack::angle(const PoseMeasurement& measured, const Symmetries& symmetries) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Hypothesis& hypothesis : hypotheses_) {
    const Eigen::Isometry3d& T = hypothesis.filter.T_world_object();
    nearest = std::min(
        nearest,
        local_coordinates_about_world(nearest_equivalent(measured.T_world_object, T, symmetries), T).tail<3>().norm());
  }
  return nearest;
}

}  // namespace houghstream::tracks
