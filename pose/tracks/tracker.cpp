#include "pose/tracks/tracker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "pipeline/base/check_settings.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/base/logit.hpp"
#include "pipeline/types/frame_time.hpp"

namespace houghstream::tracks {

Tracker::Tracker(TrackModels models, ObjectTrackerSettings settings) : models_(std::move(models)), settings_(settings) {
  check_settings(settings, "settings of a tracker");
}

// The method is on one page; its steps follow below, about in the order of their calls.
std::optional<WorldObjects> Tracker::update(const FrameObservation& received) {
  refused_ = 0;
  CameraClock* camera = begin_frame(received);
  if (camera == nullptr) return std::nullopt;
  const FrameId frame{received.poses.frame.channel, camera->utime};  // time on the world's clock
  for (Track& track : tracks_) {
    track.pose.predict(frame.utime);
    track.is_observed = track.last_seen == frame;  // observed by another result of the same frame
  }
  ObjectPoses poses = names_.resolve(received, models_, tracks_, settings_.pose.same_rotation_rad);
  poses.frame = frame;
  std::optional<Detections> renamed;
  if (received.detections != nullptr) renamed = names_.resolve(*received.detections);
  FrameObservation observation{poses};
  observation.detections = renamed ? &*renamed : received.detections;
  observation.T_world_camera = received.T_world_camera;
  observation.image = received.image;
  const std::vector<PoseObservation> observed = observe_new_poses(observation, *camera);
  const std::vector<PoseObservation> unassigned = associate(observed, camera->dt_s);
  update_unobserved_tracks(observation, observed, *camera);
  for (const PoseObservation& pose : unassigned) begin_track(pose);
  confirm_tracks(frame.utime);
  forget_tracks(frame.utime);
  return report(received, frame.utime);
}

/// Sets the camera's clock to the frame; returns null where the frame is skipped.
CameraClock* Tracker::begin_frame(const FrameObservation& received) {
  const FrameId& id = received.poses.frame;
  const StampedFrame frame{id, received.number, received.newest_utime.value_or(id.utime)};
  const TimeOrder order = clock_.classify(frame);
  if (order == TimeOrder::kLate) return nullptr;
  if (order == TimeOrder::kReset) reset();
  return &clock_.set(frame);
}

namespace {

/// Returns whether the numbers show that the source, or its log, was restarted: they fall, or are of another run.
bool is_restarted(const FrameNumber& before, const FrameNumber& after) {
  if (before.run != 0 && after.run != 0 && before.run != after.run) return true;
  return before.sequence && after.sequence && *after.sequence < *before.sequence;
}

bool is_sequence_higher(const FrameNumber& before, const FrameNumber& after) {
  return before.run == after.run && before.sequence && after.sequence && *after.sequence > *before.sequence;
}

}  // namespace

TimeOrder WorldClock::classify(const StampedFrame& frame) {
  constexpr int kMaxStaleResults = 30;  // consecutive results older than another camera's before a new world begins
  // Frames that came later have earlier times: this camera's clock was set back after this frame was taken.
  if (seconds_between(frame.newest_utime, frame.id.utime) > kMaxOvertakenS) return TimeOrder::kLate;
  const std::int64_t utime = shifted(frame.id.utime, offset_us_);
  const auto known = cameras_.find(frame.id.channel);
  if (known != cameras_.end()) {
    const TimeOrder order = classify_known_camera(known->second, frame, utime);
    if (order != TimeOrder::kNext) return order;
  } else if (newest_ && classify_forward_jump(newest_->utime, frame, utime) == TimeOrder::kLate) {
    return TimeOrder::kLate;
  }
  // Known or plausible by its own camera, which may have changed the offset; now against the other cameras: 30 results
  // in a row that are too old mean that the newest one's camera has ended.
  const std::int64_t now = shifted(frame.id.utime, offset_us_);
  if (!newest_ || seconds_between(now, newest_->utime) <= kMaxOvertakenS) return TimeOrder::kNext;
  ++stale_results_;
  require(
      stale_results_ >= kMaxStaleResults,
      "frame {} is {:.1f} s older than the last one of {}, expected cameras whose clocks, and results, are within {} "
      "s of one another",
      to_string(frame.id), seconds_between(now, newest_->utime), newest_->channel, kMaxOvertakenS);
  log_new_world(frame.id, newest_->utime);
  return TimeOrder::kReset;
}

TimeOrder WorldClock::classify_known_camera(const Camera& camera, const StampedFrame& frame, std::int64_t utime) {
  constexpr double kMaxIntervals = 3.0;  // results may come seldom
  const std::int64_t last_utime = camera.clock.utime;
  if (seconds_between(shifted(frame.newest_utime, offset_us_), last_utime) > kMaxOvertakenS)
    return classify_backward_jump(camera, frame, utime);
  const bool is_other_run = frame.number.run != camera.number.run && frame.number.run != 0 && camera.number.run != 0;
  if (utime <= last_utime && is_other_run) {
    log_new_world(frame.id, last_utime);
    return TimeOrder::kReset;
  }
  if (utime < last_utime) return TimeOrder::kLate;
  const double passed_s = seconds_between(last_utime, utime);
  if (passed_s <= std::max(kMaxOvertakenS, kMaxIntervals * camera.interval_s)) return TimeOrder::kNext;
  return classify_forward_jump(last_utime, frame, utime);
}

/// Classifies a result of a camera whose frames have gone back in time.
TimeOrder WorldClock::classify_backward_jump(const Camera& camera, const StampedFrame& frame, std::int64_t utime) {
  const std::int64_t last_utime = camera.clock.utime;
  if (!is_restarted(camera.number, frame.number)) {
    const auto unconfirmed = unconfirmed_.find(frame.id.channel);
    const std::int64_t unconfirmed_utime =
        unconfirmed == unconfirmed_.end() ? utime : unconfirmed->second;  // before it is replaced
    if (!confirm_jump(last_utime, frame.id, utime)) return TimeOrder::kLate;
    if (is_sequence_higher(camera.number, frame.number)) {
      warn(
          fmt::format("frame {} is {:.1f} s older than the last one, though its number is higher: the camera's clock "
                      "was set back, and the world goes on",
                      to_string(frame.id), seconds_between(utime, last_utime)));
      // two frame intervals after the camera's last frame: the unconfirmed frame in between was skipped
      const std::int64_t apart_us =
          microseconds_between(std::min(unconfirmed_utime, utime), std::max(unconfirmed_utime, utime));
      set_offset(shifted(last_utime, 2 * std::min<std::int64_t>(apart_us, 1'000'000)), frame.id);
      return TimeOrder::kNext;
    }
  }
  log_new_world(frame.id, last_utime);
  return TimeOrder::kReset;
}

/// Classifies a result far ahead: it is skipped until it is confirmed; then the world's clock moves on, at most a
/// minute.
TimeOrder WorldClock::classify_forward_jump(std::int64_t last_utime, const StampedFrame& frame, std::int64_t utime) {
  constexpr std::int64_t kMaxStep_us = 60'000'000;
  if (seconds_between(last_utime, utime) <= kMaxOvertakenS) return TimeOrder::kNext;
  const bool is_confirmed_by_another_camera = std::abs(seconds_between(newest_->utime, utime)) <= kMaxOvertakenS;
  if (!is_confirmed_by_another_camera && !confirm_jump(last_utime, frame.id, utime)) return TimeOrder::kLate;
  if (microseconds_between(newest_->utime, utime) > kMaxStep_us)
    set_offset(shifted(newest_->utime, kMaxStep_us), frame.id);
  return TimeOrder::kNext;
}

/// Notes the time of a frame that lies far from its camera's last one. Returns whether the frame noted before it lies
/// beside it, which a single wrong stamp does not. Another result of the same frame confirms nothing.
bool WorldClock::confirm_jump(std::int64_t last_utime, const FrameId& frame, std::int64_t utime) {
  const auto [unconfirmed, is_first] = unconfirmed_.emplace(frame.channel, utime);
  if (is_first || unconfirmed->second == utime) return false;
  const double distance_s = std::abs(seconds_between(unconfirmed->second, utime));
  const bool confirmed = distance_s < std::abs(seconds_between(last_utime, utime));
  unconfirmed->second = utime;
  return confirmed;
}

void WorldClock::set_offset(std::int64_t world_utime, const FrameId& frame) {
  offset_us_ = microseconds_between(frame.utime, world_utime);
}

void WorldClock::log_new_world(const FrameId& frame, std::int64_t last_utime) {
  warn(fmt::format("frame {} is {:.1f} s older than the last one: a new world begins", to_string(frame),
                   seconds_between(shifted(frame.utime, offset_us_), last_utime)));
}

void WorldClock::warn(const std::string& line) {
  const auto admitted = throttle_.admit("world", line, LogThrottle::Clock::now());
  if (admitted) log_warning("{}", *admitted);
}

CameraClock& WorldClock::set(const StampedFrame& frame) {
  constexpr double kDefaultInterval_s = 1.0 / 30.0;
  constexpr double kMaxInterval_s = 0.1;
  stale_results_ = 0;
  const FrameId now{frame.id.channel, shifted(frame.id.utime, offset_us_)};
  unconfirmed_.erase(now.channel);
  if (!newest_ || now.utime > newest_->utime) newest_ = now;
  Camera& camera = cameras_[now.channel];
  CameraClock& clock = camera.clock;
  const double passed_s = seconds_between(clock.utime, now.utime);
  const double seconds = clock.results == 0 ? kDefaultInterval_s : std::min(kMaxInterval_s, passed_s);
  if (clock.results > 0 && passed_s > 0.0) camera.interval_s = passed_s;
  if (clock.results == 0 || now.utime != clock.utime) {
    clock = CameraClock();
    clock.utime = now.utime;
    clock.dt_s = seconds;
  }
  camera.number = frame.number;
  ++clock.results;
  return clock;
}

/// Returns the poses of classes that no earlier result of this frame has had.
std::vector<PoseObservation> Tracker::observe_new_poses(const FrameObservation& observation,
                                                        CameraClock& camera) const {
  std::vector<PoseObservation> poses = observe_poses(observation.poses, observation.T_world_camera, models_);
  std::set<std::string>& known = camera.classes;
  poses.erase(std::remove_if(poses.begin(), poses.end(),
                             [&](const PoseObservation& pose) { return known.count(pose.class_name) > 0; }),
              poses.end());
  for (const PoseObservation& pose : poses) known.insert(pose.class_name);
  return poses;
}

/// Assigns the poses to the objects of their class and updates these; returns the poses without an object near them.
std::vector<PoseObservation> Tracker::associate(const std::vector<PoseObservation>& poses, double dt_s) {
  std::set<std::string> classes;
  for (const PoseObservation& pose : poses) classes.insert(pose.class_name);
  std::vector<PoseObservation> unassigned;
  for (const std::string& class_name : classes) {
    const ClassGroup group = group_by_class(class_name, poses, models_, tracks_);
    const std::vector<int> assigned = assign_poses(group, settings_.association);
    std::vector<bool> is_assigned(group.measured.size(), false);
    for (std::size_t i = 0; i < group.objects.size(); ++i) {
      if (assigned[i] < 0) continue;
      is_assigned[assigned[i]] = true;
      update_track(*group.objects[i], *group.measured[assigned[i]], dt_s);
    }
    const int instances =
        static_cast<int>(std::count_if(group.objects.begin(), group.objects.end(),
                                       [](const Track* track) { return track->id != 0 && track->is_observed; }));
    max_instances_[class_name] = std::max(max_instances_[class_name], instances);
    for (std::size_t j = 0; j < group.measured.size(); ++j) {
      const PoseObservation& pose = *group.measured[j];
      if (!is_assigned[j] && !is_space_occupied(pose.measured, group, settings_.association))
        unassigned.push_back(pose);
    }
  }
  return unassigned;
}

void Tracker::update_track(Track& track, const PoseObservation& pose, double dt_s) {
  constexpr double kReferenceRate_hz = 30.0;
  const double frames_at_30_hz = std::clamp(dt_s * kReferenceRate_hz, 0.5, 1.5);
  track.pose.update(pose, symmetries_of(models_, track.class_name), track.free_space_violation_s > 0.0);
  track.log_odds =
      std::min(settings_.existence.max_log_odds, track.log_odds + frames_at_30_hz * settings_.existence.gain *
                                                                      std::max(0.3, quality_logit(pose.quality)));
  ++track.observed_frames;
  track.is_observed = true;
  track.free_space_violation_s = 0.0;
  track.last_seen = pose.frame;
  track.state = TrackState::kVisible;
  track.reason = fmt::format("seen by {}", pose.frame.channel);
}

/// Updates the tracks without a pose. A frame counts once against each, however many results it has.
void Tracker::update_unobserved_tracks(const FrameObservation& observation, const std::vector<PoseObservation>& poses,
                                       CameraClock& camera) {
  searched_classes_.note(observation.poses);
  UnobservedContext context{observation, poses, models_};
  context.reach_m = settings_.association.reach_m;
  context.coast_s = settings_.pose.motion.coast_s;
  const bool is_first_result = camera.results == 1;
  std::set<std::string> newly_missed;  // added at the end: the result counts against every track of a class
  for (Track& track : tracks_) {
    if (!track.is_present() || track.is_observed) continue;
    const bool is_first_to_search = camera.missed.count(track.class_name) == 0 &&
                                    searched_classes_.has_searched(observation.poses, track.class_name);
    const AbsenceEvidence absence{camera.dt_s, is_first_result, is_first_to_search};
    if (absence.by_recognition) newly_missed.insert(track.class_name);
    if (absence.by_depth || absence.by_recognition) update_unobserved(context, absence, settings_.existence, track);
  }
  camera.missed.insert(newly_missed.begin(), newly_missed.end());
}

namespace {

std::set<std::string> reported_classes(const ObjectPoses& poses) {
  std::set<std::string> names;
  for (const ObjectPose& pose : poses.poses) {
    if (pose.status != PoseStatus::kNoModel) names.insert(pose.class_name);
  }
  return names;
}

bool have_common(const std::set<std::string>& a, const std::set<std::string>& b) {
  return std::any_of(a.begin(), a.end(), [&](const std::string& name) { return b.count(name) > 0; });
}

}  // namespace

void SearchedClasses::note(const ObjectPoses& poses) {
  constexpr std::size_t kMax = 500;  // classes of one detector
  const std::set<std::string> names = reported_classes(poses);
  Camera& camera = cameras_[poses.frame.channel];
  if (camera.utime != poses.frame.utime) camera.classes.clear();
  camera.utime = poses.frame.utime;
  // Results without a class in common are of several detectors.
  if (!names.empty() && !camera.classes.empty() && !have_common(names, camera.classes)) camera.has_several = true;
  camera.classes.insert(names.begin(), names.end());
  for (const std::string& name : names) {
    DetectorClasses& reported = reported_with_[name];
    if (reported.classes.size() < kMax) reported.classes.insert(names.begin(), names.end());
    reported.utime = std::max(reported.utime, poses.frame.utime);
  }
}

bool SearchedClasses::has_searched(const ObjectPoses& poses, const std::string& class_name) const {
  const auto camera = cameras_.find(poses.frame.channel);
  if (camera == cameras_.end() || !camera->second.has_several) return true;
  const auto reported = reported_with_.find(class_name);
  if (reported == reported_with_.end()) return true;
  // It was searched by this result's detector, or its own detector has fallen silent.
  return have_common(reported_classes(poses), reported->second.classes) || !is_reporting(class_name, poses.frame.utime);
}

/// Returns whether the detector of the class has reported anything within the last second.
bool SearchedClasses::is_reporting(const std::string& class_name, std::int64_t utime) const {
  constexpr double kTimeout_s = 1.0;
  const std::set<std::string>& classes = reported_with_.at(class_name).classes;
  return std::any_of(classes.begin(), classes.end(), [&](const std::string& name) {
    const auto reported = reported_with_.find(name);
    return reported != reported_with_.end() && seconds_between(reported->second.utime, utime) <= kTimeout_s;
  });
}

void Tracker::begin_track(const PoseObservation& pose) {
  if (!evict_oldest()) {
    ++refused_;
    return;
  }
  Track track{PoseTrack(pose, settings_.pose)};
  track.class_id = pose.class_id;
  track.class_name = pose.class_name;
  track.observed_frames = 1;
  track.first_utime = pose.frame.utime;
  track.last_seen = pose.frame;
  track.reason = fmt::format("seen by {}", pose.frame.channel);
  track.log_odds = settings_.existence.prior + settings_.existence.gain * quality_logit(pose.quality);
  track.is_observed = true;
  tracks_.push_back(std::move(track));
}

/// Makes space for one more object by removing the one that was deleted first; returns false where none is deleted.
bool Tracker::evict_oldest() {
  if (tracks_.size() < settings_.max_objects) return true;
  auto oldest = tracks_.end();
  for (auto it = tracks_.begin(); it != tracks_.end(); ++it) {
    if (!it->is_present() && (oldest == tracks_.end() || it->deleted_utime < oldest->deleted_utime)) oldest = it;
  }
  if (oldest == tracks_.end()) return false;
  tracks_.erase(oldest);
  return true;
}

/// Gives each candidate that was observed enough a number: the one of the earlier object that it re-identifies, or a
/// new one.
void Tracker::confirm_tracks(std::int64_t utime) {
  const ExistenceSettings& existence = settings_.existence;
  for (Track& candidate : tracks_) {
    const double observed_s = seconds_between(candidate.first_utime, candidate.last_seen.utime);
    if (candidate.id != 0 || !candidate.is_present() || candidate.log_odds < existence.confirm_log_odds ||
        candidate.observed_frames < existence.min_frames || observed_s < existence.min_duration_s)
      continue;
    if (Track* earlier = find_reidentified(candidate, utime)) {
      const std::int64_t id = earlier->id;
      candidate.id = id;
      candidate.first_utime = earlier->first_utime;
      candidate.observed_frames += earlier->observed_frames;
      earlier->id = -1;  // marks it for forget_tracks()
      log_info("{} #{} re-identified at a new pose", candidate.class_name, id);
    } else {
      candidate.id = next_id_++;
      log_info("{} #{} is there, seen by {}", candidate.class_name, candidate.id, candidate.last_seen.channel);
    }
  }
}

/// Returns the earlier object that a candidate re-identifies: one of its class that is deleted, moving or contradicted
/// by depth, or one that a hand may occlude, if no more of its class are visible now, the candidate included, than have
/// been at once before.
Track* Tracker::find_reidentified(const Track& candidate, std::int64_t utime) {
  int visible = 1;
  for (const Track& track : tracks_) {
    if (track.id != 0 && track.class_name == candidate.class_name && track.is_observed) ++visible;
  }
  Track* best = nullptr;
  double min_cost = 0.0;
  for (Track& track : tracks_) {
    // A track whose number another candidate has received in this frame is no object any more.
    if (track.id <= 0 || track.class_name != candidate.class_name || track.is_observed) continue;
    const double unseen_s = seconds_between(track.last_seen.utime, utime);
    const bool is_hand_occluded = track.state == TrackState::kHidden && unseen_s < settings_.hand_occlusion_s;
    const bool has_left = track.pose.filter().moving() || track.free_space_violation_s > 0.0;
    const bool is_available =
        !track.is_present() || has_left || (is_hand_occluded && visible <= max_instances_[candidate.class_name]);
    if (!is_available || track.last_seen.utime > candidate.last_seen.utime) continue;
    // seconds unseen; objects that are gone cost 5 s more; a metre counts as a second
    const double cost =
        unseen_s + (track.is_present() ? 0.0 : 5.0) +
        track.pose.distance({utime, candidate.pose.filter().T_world_object(), Covariance6::Identity()},
                            symmetries_of(models_, track.class_name), centre_of(models_, track.class_name));
    if (best != nullptr && cost >= min_cost) continue;
    best = &track;
    min_cost = cost;
  }
  return best;
}

void Tracker::forget_tracks(std::int64_t utime) {
  const auto is_expired = [&](const Track& track) {
    if (track.id < 0) return true;
    if (track.is_present()) return false;
    return track.id == 0 || seconds_between(track.deleted_utime, utime) > settings_.reidentification_s;
  };
  tracks_.erase(std::remove_if(tracks_.begin(), tracks_.end(), is_expired), tracks_.end());
  // An untrusted sender may make up names of classes without end.
  std::set<std::string> known;
  for (const Track& track : tracks_) known.insert(track.class_name);
  for (auto it = max_instances_.begin(); it != max_instances_.end();)
    it = known.count(it->first) > 0 ? std::next(it) : max_instances_.erase(it);
  searched_classes_.keep_only(known);
}

void SearchedClasses::keep_only(const std::set<std::string>& classes) {
  for (auto it = reported_with_.begin(); it != reported_with_.end();)
    it = classes.count(it->first) > 0 ? std::next(it) : reported_with_.erase(it);
}

/// Returns the objects that are published, with times of the frames' own clocks.
WorldObjects Tracker::report(const FrameObservation& received, std::int64_t utime) const {
  WorldObjects out;
  out.frame = received.poses.frame;
  out.world_number = world_number_;
  out.T_world_camera = received.T_world_camera;
  out.stages = received.poses.stages;
  for (const Track& track : tracks_) {
    if (track.id == 0) continue;
    if (!track.is_present() && seconds_between(track.deleted_utime, utime) > settings_.gone_report_s) continue;
    const MotionFilter& filter = track.pose.filter();
    TrackedObject object;
    object.track_id = track.id;
    object.class_id = track.class_id;
    object.class_name = track.class_name;
    object.state = track.state;
    object.probability = static_cast<float>(logistic(track.log_odds));
    object.moving = filter.moving();
    object.T_world_object = filter.T_world_object();
    object.covariance = filter.covariance();
    object.velocity = filter.velocity();
    object.seen = track.observed_frames;
    object.first_utime = clock_.to_camera_time(track.first_utime);
    object.last_seen = track.last_seen;
    object.last_seen.utime = clock_.to_camera_time(track.last_seen.utime);
    object.reason = track.reason;
    out.objects.push_back(std::move(object));
  }
  std::sort(out.objects.begin(), out.objects.end(),
            [](const TrackedObject& a, const TrackedObject& b) { return a.track_id < b.track_id; });
  return out;
}

void Tracker::reset() {
  tracks_.clear();
  clock_.reset();
  searched_classes_ = {};
  max_instances_.clear();
  next_id_ = 1;
  ++world_number_;
}

void WorldClock::reset() {
  cameras_.clear();
  unconfirmed_.clear();
  newest_.reset();
  stale_results_ = 0;
  offset_us_ = 0;
}

void Tracker::set_models(TrackModels models) {
  const ModelChange change = find_model_change(models_, models);
  models_ = std::move(models);
  names_.update(change, models_);
  retire_tracks(change.removed, settings_.existence.delete_log_odds, tracks_);
  rename_tracks(change.renamed, models_, tracks_);
  rename_counts(change.renamed, max_instances_);
}

}  // namespace houghstream::tracks
