#include "pose/tracks/tracker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>

#include "pipeline/base/check_settings.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/base/log_odds.hpp"
#include "pose/tracks/class_names.hpp"
#include "pose/tracks/searched_classes.hpp"
#include "pose/tracks/world_clock.hpp"

namespace houghstream::tracks {

struct Tracker::State {
  TrackModels models;
  ObjectTrackerSettings settings;
  std::vector<Track> tracks;  // by when they were begun; numbers follow in the order of confirmation
  WorldClock clock;
  SearchedClasses looked_for;
  ClassNames names;
  std::map<std::string, int> max_instances;  // by class: instances that were seen in one frame
  std::int64_t next_id = 1;
  int world_number = 1;
  std::size_t refused = 0;  // poses of the last frame, for which there was no room

  void begin_world();
  void rename_tracks(const std::map<std::string, std::string>& renamed);
  void drop_doubles(std::size_t renamed_index);
  void retire_tracks(const std::set<std::string>& removed);
  WorldObjects update(const FrameObservation& seen, CameraClock& camera);
  CameraClock* begin_frame(const FrameObservation& seen);
  std::vector<PoseObservation> new_poses(const FrameObservation& seen, CameraClock& camera) const;
  std::vector<PoseObservation> associate(const std::vector<PoseObservation>& poses, const std::string& class_name,
                                         double seconds);
  void take(Track& track, const PoseObservation& pose, double seconds);
  bool has_room();
  void begin(const PoseObservation& pose);
  void update_unobserved_tracks(const FrameObservation& seen, const std::vector<PoseObservation>& poses,
                                CameraClock& camera);
  void confirm(std::int64_t utime);
  Track* find_reidentified(const Track& candidate, std::int64_t utime);
  void forget(std::int64_t utime);
  WorldObjects report(const FrameObservation& seen) const;
};

Tracker::Tracker(TrackModels models, ObjectTrackerSettings settings) : state_(std::make_unique<State>()) {
  check_settings(settings, "settings of a tracker");
  state_->models = std::move(models);
  state_->settings = settings;
}
Tracker::~Tracker() = default;
Tracker::Tracker(Tracker&&) noexcept = default;

void Tracker::set_models(TrackModels models) {
  const ModelChange change = find_model_change(state_->models, models);
  state_->models = std::move(models);
  state_->names.update(change, state_->models);
  state_->retire_tracks(change.removed);
  state_->rename_tracks(change.renamed);
}

void Tracker::State::retire_tracks(const std::set<std::string>& removed) {
  const auto is_removed = [&](const Track& track) { return removed.count(track.class_name) > 0; };
  tracks.erase(std::remove_if(tracks.begin(), tracks.end(),
                              [&](const Track& track) { return track.id == 0 && is_removed(track); }),
               tracks.end());
  for (Track& track : tracks) {
    if (!track.there() || !is_removed(track)) continue;
    track.deleted_utime = track.pose.filter().utime();
    track.log_odds = std::min(track.log_odds, settings.existence.gone);
    track.state = TrackState::kGone;
    track.reason = "its class has left the object store";
    log_info("{} #{} is gone: {}", track.class_name, track.id, track.reason);
  }
}

void Tracker::State::rename_tracks(const std::map<std::string, std::string>& renamed) {
  std::vector<std::size_t> changed;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    Track& track = tracks[i];
    const auto found = renamed.find(track.class_name);
    if (found == renamed.end()) continue;
    if (track.id != 0 && track.there()) log_info("{} #{} is called {} now", track.class_name, track.id, found->second);
    track.class_name = found->second;
    changed.push_back(i);
  }
  for (const std::size_t i : changed) drop_doubles(i);
  tracks.erase(std::remove_if(tracks.begin(), tracks.end(), [](const Track& track) { return track.id < 0; }),
               tracks.end());
  std::map<std::string, int> counts;
  for (const auto& [name, count] : max_instances) {
    const auto found = renamed.find(name);
    int& most = counts[found == renamed.end() ? name : found->second];
    most = std::max(most, count);
  }
  max_instances = std::move(counts);
}

/// Marks what was begun in the place of a renamed object while only its new name came, for being forgotten.
void Tracker::State::drop_doubles(std::size_t renamed_index) {
  const Track& kept = tracks[renamed_index];
  if (kept.id <= 0 || !kept.there()) return;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    Track& other = tracks[i];
    if (i == renamed_index || other.class_name != kept.class_name || (other.id > 0 && other.id < kept.id)) continue;
    const double apart_m =
        kept.pose.distance({kept.pose.filter().utime(), other.pose.filter().T_world_object(), Covariance6::Identity()},
                           symmetries_of(models, kept.class_name), centre_of(models, kept.class_name));
    if (apart_m < 0.5 * radius_of(models, kept.class_name)) other.id = -1;
  }
}

void Tracker::begin_world() {
  state_->begin_world();
}

std::size_t Tracker::refused() const {
  return state_->refused;
}

std::optional<WorldObjects> Tracker::update(const FrameObservation& seen) {
  State& state = *state_;
  state.refused = 0;
  CameraClock* camera = state.begin_frame(seen);
  if (camera == nullptr) return std::nullopt;
  const std::int64_t ahead_us = state.clock.ahead_us();
  const std::int64_t utime = ahead_us == 0 ? seen.poses.frame.utime : camera->utime;
  for (Track& track : state.tracks) track.pose.predict(utime);
  ObjectPoses poses = state.names.resolve(seen, state.models, state.tracks, state.settings.pose.same_rotation_rad);
  poses.frame.utime = utime;
  std::optional<Detections> renamed;
  if (seen.detections != nullptr) renamed = state.names.resolve(*seen.detections);
  const Detections* detections = renamed ? &*renamed : seen.detections;
  WorldObjects world = state.update({poses, detections, seen.T_world_camera, seen.image}, *camera);
  world.frame = seen.poses.frame;
  if (ahead_us == 0) return world;
  for (TrackedObject& object : world.objects) {
    object.first_utime = microseconds_between(ahead_us, object.first_utime);
    object.last_seen.utime = microseconds_between(ahead_us, object.last_seen.utime);
  }
  return world;
}

/// The world after a frame whose time is on the world's clock, and whose classes are called as they are today.
WorldObjects Tracker::State::update(const FrameObservation& seen, CameraClock& camera) {
  const FrameId& frame = seen.poses.frame;
  const std::vector<PoseObservation> poses = new_poses(seen, camera);
  for (Track& track : tracks) track.seen_now = track.last_seen == frame;  // by another result of the same frame
  std::set<std::string> classes;
  for (const PoseObservation& pose : poses) classes.insert(pose.class_name);
  std::vector<PoseObservation> unknown;
  for (const std::string& class_name : classes) {
    const std::vector<PoseObservation> left = associate(poses, class_name, camera.seconds);
    unknown.insert(unknown.end(), left.begin(), left.end());
  }
  update_unobserved_tracks(seen, poses, camera);
  for (const PoseObservation& pose : unknown) begin(pose);
  confirm(frame.utime);
  forget(frame.utime);
  return report(seen);
}

void Tracker::State::begin_world() {
  tracks.clear();
  clock.begin_world();
  looked_for = {};
  max_instances.clear();
  next_id = 1;
  ++world_number;
}

/// The camera's clock, which the frame has set; null where the frame is passed over.
CameraClock* Tracker::State::begin_frame(const FrameObservation& seen) {
  const FrameId& id = seen.poses.frame;
  const StampedFrame frame{id, seen.number, seen.newest_utime.value_or(id.utime)};
  const TimeOrder order = clock.order_of(frame);
  if (order == TimeOrder::kLate) return nullptr;
  if (order == TimeOrder::kAnew) begin_world();
  return &clock.set(frame);
}

/// The poses of classes that this frame was not told of yet: another detector's, or all.
std::vector<PoseObservation> Tracker::State::new_poses(const FrameObservation& seen, CameraClock& camera) const {
  std::vector<PoseObservation> poses = observe_poses(seen.poses, seen.T_world_camera, models);
  std::set<std::string>& told = camera.classes;
  poses.erase(std::remove_if(poses.begin(), poses.end(),
                             [&](const PoseObservation& pose) { return told.count(pose.class_name) > 0; }),
              poses.end());
  for (const PoseObservation& pose : poses) told.insert(pose.class_name);
  return poses;
}

/// Gives the poses of a class to its objects; those that no object is near are left.
std::vector<PoseObservation> Tracker::State::associate(const std::vector<PoseObservation>& poses,
                                                       const std::string& class_name, double seconds) {
  const ClassGroup one = group_by_class(class_name, poses, models, tracks);
  const std::vector<int> given = assign_poses(one, settings.association);
  std::vector<bool> taken(one.measured.size(), false);
  for (std::size_t i = 0; i < one.objects.size(); ++i) {
    if (given[i] < 0) continue;
    taken[given[i]] = true;
    take(*one.objects[i], *one.measured[given[i]], seconds);
  }
  const int together = static_cast<int>(std::count_if(
      one.objects.begin(), one.objects.end(), [](const Track* track) { return track->id != 0 && track->seen_now; }));
  max_instances[class_name] = std::max(max_instances[class_name], together);
  std::vector<PoseObservation> left;
  for (std::size_t j = 0; j < one.measured.size(); ++j) {
    const PoseObservation& pose = *one.measured[j];
    if (!taken[j] && !is_space_occupied(pose.measured, one, settings.association)) left.push_back(pose);
  }
  return left;
}

void Tracker::State::take(Track& track, const PoseObservation& pose, double seconds) {
  constexpr double kRateHz = 30.0;
  constexpr double kMax = 4.0;
  const double share = std::clamp(seconds * kRateHz, 0.5, 1.5);
  track.pose.take(pose, symmetries_of(models, track.class_name), track.seen_through_s > 0.0);
  track.log_odds =
      std::min(settings.existence.most,
               track.log_odds + share * settings.existence.gain * std::clamp(log_odds_of(pose.quality), 0.3, kMax));
  ++track.seen;
  track.seen_now = true;
  track.seen_through_s = 0.0;
  track.last_seen = pose.frame;
  track.state = TrackState::kVisible;
  track.reason = fmt::format("seen by {}", pose.frame.channel);
}

/// For one object more: what has been gone longest makes room.
bool Tracker::State::has_room() {
  if (tracks.size() < settings.max_objects) return true;
  auto oldest = tracks.end();
  for (auto it = tracks.begin(); it != tracks.end(); ++it) {
    if (!it->there() && (oldest == tracks.end() || it->deleted_utime < oldest->deleted_utime)) oldest = it;
  }
  if (oldest == tracks.end()) return false;
  tracks.erase(oldest);
  return true;
}

void Tracker::State::begin(const PoseObservation& pose) {
  if (!has_room()) {
    ++refused;
    return;
  }
  Track track{PoseTrack(pose, settings.pose)};
  track.class_id = pose.class_id;
  track.class_name = pose.class_name;
  track.seen = 1;
  track.first_utime = pose.frame.utime;
  track.last_seen = pose.frame;
  track.reason = fmt::format("seen by {}", pose.frame.channel);
  track.log_odds = settings.existence.prior + settings.existence.gain * log_odds_of(pose.quality);
  track.seen_now = true;
  tracks.push_back(std::move(track));
}

/// What is not seen is missed once a frame, however many results that has.
void Tracker::State::update_unobserved_tracks(const FrameObservation& seen, const std::vector<PoseObservation>& poses,
                                              CameraClock& camera) {
  looked_for.note(seen.poses);
  UnobservedContext unseen{seen, poses, models};
  unseen.reach_m = settings.association.reach_m;
  unseen.coast_s = settings.pose.motion.coast_s;
  std::set<std::string> missed_now;
  for (Track& track : tracks) {
    if (!track.there() || track.seen_now) continue;
    const MissedDetection missed{
        camera.seconds, camera.results == 1,
        camera.missed.count(track.class_name) == 0 && looked_for.has_searched(seen.poses, track.class_name)};
    if (missed.by_recognition) missed_now.insert(track.class_name);
    if (missed.by_depth || missed.by_recognition) update_unobserved(unseen, missed, settings.existence, track);
  }
  camera.missed.insert(missed_now.begin(), missed_now.end());
}

/// The object that a candidate was before it was carried or taken away: one of its class that is gone, that is not
/// where it was, or that a hand hides while no more of its class have ever been seen together.
Track* Tracker::State::find_reidentified(const Track& candidate, std::int64_t utime) {
  int visible = 1;
  for (const Track& track : tracks) {
    if (track.id != 0 && track.class_name == candidate.class_name && track.seen_now) ++visible;
  }
  Track* best = nullptr;
  double best_rank = 0.0;
  for (Track& track : tracks) {
    // One that this frame has given its number to another candidate is nobody's any more.
    if (track.id <= 0 || track.class_name != candidate.class_name || track.seen_now) continue;
    const double unseen_s = seconds_between(track.last_seen.utime, utime);
    const bool handled = track.state == TrackState::kHidden && unseen_s < settings.hand_occlusion_s;
    const bool lost = track.pose.filter().moving() || track.seen_through_s > 0.0;
    const bool free = !track.there() || lost || (handled && visible <= max_instances[candidate.class_name]);
    if (!free || track.last_seen.utime > candidate.last_seen.utime) continue;
    const double rank =
        unseen_s + (track.there() ? 0.0 : 5.0) +
        track.pose.distance({utime, candidate.pose.filter().T_world_object(), Covariance6::Identity()},
                            symmetries_of(models, track.class_name), centre_of(models, track.class_name));
    if (best != nullptr && rank >= best_rank) continue;
    best = &track;
    best_rank = rank;
  }
  return best;
}

/// Candidates that have been seen enough become objects, or are the ones that were lost.
void Tracker::State::confirm(std::int64_t utime) {
  const ExistenceSettings& how = settings.existence;
  for (Track& candidate : tracks) {
    const double spread_s = seconds_between(candidate.first_utime, candidate.last_seen.utime);
    if (candidate.id != 0 || !candidate.there() || candidate.log_odds < how.confirmed ||
        candidate.seen < how.confirmed_frames || spread_s < how.confirmed_s)
      continue;
    if (Track* earlier = find_reidentified(candidate, utime)) {
      const std::int64_t id = earlier->id;
      candidate.id = id;
      candidate.first_utime = earlier->first_utime;
      candidate.seen += earlier->seen;
      earlier->id = -1;  // forgotten below
      log_info("{} #{} is in another place", candidate.class_name, id);
    } else {
      candidate.id = next_id++;
      log_info("{} #{} is there, seen by {}", candidate.class_name, candidate.id, candidate.last_seen.channel);
    }
  }
}

void Tracker::State::forget(std::int64_t utime) {
  const auto over = [&](const Track& track) {
    if (track.id < 0) return true;
    if (track.there()) return false;
    return track.id == 0 || seconds_between(track.deleted_utime, utime) > settings.reidentification_s;
  };
  tracks.erase(std::remove_if(tracks.begin(), tracks.end(), over), tracks.end());
  // Other classes' names a sender of rubbish may make up without end.
  std::set<std::string> known;
  for (const Track& track : tracks) known.insert(track.class_name);
  for (auto it = max_instances.begin(); it != max_instances.end();)
    it = known.count(it->first) > 0 ? std::next(it) : max_instances.erase(it);
  looked_for.keep_only(known);
}

WorldObjects Tracker::State::report(const FrameObservation& seen) const {
  WorldObjects out;
  out.frame = seen.poses.frame;
  out.world_number = world_number;
  out.T_world_camera = seen.T_world_camera;
  out.stages = seen.poses.stages;
  for (const Track& track : tracks) {
    if (track.id == 0) continue;
    if (!track.there() && seconds_between(track.deleted_utime, out.frame.utime) > settings.gone_report_s) continue;
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
    object.seen = track.seen;
    object.first_utime = track.first_utime;
    object.last_seen = track.last_seen;
    object.reason = track.reason;
    out.objects.push_back(std::move(object));
  }
  std::sort(out.objects.begin(), out.objects.end(),
            [](const TrackedObject& a, const TrackedObject& b) { return a.track_id < b.track_id; });
  return out;
}

}  // namespace houghstream::tracks
