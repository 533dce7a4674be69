#include "pose/tracks/existence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "pipeline/base/log_line.hpp"
#include "pose/seen/region.hpp"
#include "pose/verification/verification.hpp"

namespace houghstream::tracks {
namespace {

/// What depth shows where an object should be.
enum class DepthShows { kNothing, kObject, kFreeSpace, kOccluder };

/// Holds the result of check_visibility().
struct VisibilityCheck {
  DepthShows shows = DepthShows::kNothing;
  double free_space_violation = 0.0;   ///< fraction of what is not occluded, 0 to 1
  bool is_boundary_continued = false;  ///< the measured surface continues beyond the object's outline
};

/// Renders the model at a pose and compares it with the depth of a frame.
VisibilityCheck check_visibility(const RgbdFrame& frame, const TrackModel& model,
                                 const Eigen::Isometry3d& T_camera_object) {
  constexpr double kTolerance_m = 0.012;
  constexpr double kMinDepth_m = 0.05;
  constexpr int kMinPx = 30;
  constexpr double kMinMeasured = 0.2;  // minimum fraction of the pixels with depth
  constexpr double kMaxOccluded = 0.6;
  constexpr double kMaxFreeSpaceViolation = 0.35;
  const Eigen::Vector3d centre = T_camera_object * model.centre;
  if (centre.z() < kMinDepth_m) return {};
  const Eigen::Vector2d pixel = frame.camera.project(centre);
  if (pixel.x() < 0.0 || pixel.y() < 0.0 || pixel.x() >= frame.camera.width || pixel.y() >= frame.camera.height)
    return {};
  const Verification verification = verify_pose(frame, model.mesh, T_camera_object, {kTolerance_m, DepthNoise{}});
  const int compared = verification.depth_inliers + verification.free_space_violations + verification.occluded;
  if (verification.rendered < kMinPx || compared < kMinMeasured * verification.rendered) return {};
  VisibilityCheck visibility;
  visibility.free_space_violation = static_cast<double>(verification.free_space_violations) /
                                    std::max(1, verification.depth_inliers + verification.free_space_violations);
  visibility.is_boundary_continued =
      verification.boundary_continuations > 0.5F * static_cast<float>(verification.boundary_samples);
  visibility.shows = DepthShows::kObject;
  if (visibility.free_space_violation > kMaxFreeSpaceViolation) visibility.shows = DepthShows::kFreeSpace;
  if (verification.occluded > kMaxOccluded * compared) visibility.shows = DepthShows::kOccluder;
  return visibility;
}

/// Returns the state of a track without a measurement, of which depth shows this.
TrackState state_of(DepthShows shows) {
  switch (shows) {
    case DepthShows::kNothing: return TrackState::kOutOfView;
    case DepthShows::kOccluder: return TrackState::kHidden;
    default: return TrackState::kUnrecognised;  // it is gone when its log odds say so
  }
}

/// Returns whether an object of another class is recognised in its place.
bool is_replaced(const UnobservedContext& context, const Track& track) {
  const Eigen::Vector3d centre = track.pose.filter().T_world_object() * centre_of(context.models, track.class_name);
  return std::any_of(context.poses.begin(), context.poses.end(), [&](const PoseObservation& pose) {
    return pose.class_name != track.class_name &&
           (pose.measured.T_world_object * centre_of(context.models, pose.class_name) - centre).norm() <
               0.5 * std::min(radius_of(context.models, pose.class_name), radius_of(context.models, track.class_name));
  });
}

/// Returns whether the class is detected at a position, camera frame, metres.
bool is_detected(const UnobservedContext& context, const std::string& class_name,
                 const Eigen::Vector3d& expected_centre) {
  const Detections* detections = context.observation.detections;
  return detections != nullptr &&
         std::any_of(detections->detections.begin(), detections->detections.end(), [&](const Detection& detection) {
           return detection.class_name == class_name &&
                  (detection.centre_camera.cast<double>() - expected_centre).norm() < context.reach_m;
         });
}

}  // namespace

void update_unobserved(const UnobservedContext& context, const AbsenceEvidence& absence,
                       const ExistenceSettings& settings, Track& track) {
  const FrameObservation& observation = context.observation;
  const auto model_entry = context.models.find(track.class_name);
  const TrackModel* model = model_entry == context.models.end() ? nullptr : &model_entry->second;
  const RgbdFrame* image = model != nullptr && observation.image ? observation.image() : nullptr;
  const Eigen::Isometry3d T_camera_object = observation.T_world_camera.inverse() * track.pose.filter().T_world_object();
  const VisibilityCheck visibility =
      image != nullptr ? check_visibility(*image, *model, T_camera_object) : VisibilityCheck{};
  const double unseen_s = seconds_between(track.last_seen.utime, observation.poses.frame.utime);
  const bool replaced = is_replaced(context, track);
  const Eigen::Vector3d expected_centre =
      T_camera_object * (model != nullptr ? model->vote_centre : Eigen::Vector3d::Zero());
  const bool detected = is_detected(context, track.class_name, expected_centre);
  double rate = 0.0;
  std::string reason;
  switch (visibility.shows) {
    case DepthShows::kFreeSpace:
      if (absence.by_depth) {
        rate = settings.free_space_rate * visibility.free_space_violation;
        track.free_space_violation_s += absence.dt_s;
      }
      reason = fmt::format("{}: free-space violation {:.0f} %", observation.poses.frame.channel,
                           100.0 * visibility.free_space_violation);
      break;
    case DepthShows::kOccluder:
      reason = fmt::format("occluded by a nearer surface in {}", observation.poses.frame.channel);
      break;
    case DepthShows::kNothing:
      reason = fmt::format("not in view of {}, or without depth", observation.poses.frame.channel);
      break;
    case DepthShows::kObject:
      if (absence.by_recognition)
        rate = visibility.is_boundary_continued ? settings.continuation_rate : detected ? 0.0 : settings.missed_rate;
      reason = fmt::format("not recognised by {}, whose depth agrees", observation.poses.frame.channel);
  }
  if (replaced && visibility.shows != DepthShows::kNothing) {
    if (absence.by_depth) rate += settings.replaced_rate;
    reason += ", where something else is";
  }
  if (track.pose.filter().moving() && unseen_s > context.coast_s) {
    if (absence.by_recognition)
      rate += (visibility.shows == DepthShows::kOccluder ? 0.25 : 1.0) * settings.moving_missed_rate;
    reason += "; it moved when it was seen last";
  }
  if (track.id == 0 && absence.by_recognition) rate += settings.candidate_rate;
  track.log_odds -= absence.dt_s * rate;
  // The last observer sets the state for a short time after its observation, where several cameras see the place.
  constexpr double kLastObserverHold_s = 0.1;
  const bool has_evidence = absence.by_recognition || visibility.shows != DepthShows::kObject;
  if (has_evidence && (track.last_seen.channel == observation.poses.frame.channel || unseen_s > kLastObserverHold_s)) {
    track.state = state_of(visibility.shows);
    track.reason = reason;
  }
  if (track.log_odds < settings.delete_log_odds) {
    track.deleted_utime = observation.poses.frame.utime;
    track.state = TrackState::kGone;
    track.reason = reason;
    if (track.id != 0)
      log_info("{} #{} is gone: {} (last seen by {} {:.2f} s before)", track.class_name, track.id, reason,
               track.last_seen.channel, unseen_s);
  }
}

}  // namespace houghstream::tracks
