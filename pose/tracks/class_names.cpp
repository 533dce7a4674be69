#include "pose/tracks/class_names.hpp"

#include <algorithm>
#include <iterator>

#include "pipeline/base/log_line.hpp"

namespace houghstream::tracks {
namespace {

bool have_same_mesh(const TrackModel& a, const TrackModel& b) {
  return a.mesh.vertices == b.mesh.vertices && a.mesh.triangles == b.mesh.triangles;
}

/// Returns the name of the class that has this number and mesh; empty where there is none.
std::string find_same_object(const TrackModels& models, const TrackModel& model) {
  const auto found = std::find_if(models.begin(), models.end(), [&](const TrackModels::value_type& other) {
    return other.second.object_id == model.object_id && have_same_mesh(other.second, model);
  });
  return found == models.end() ? std::string() : found->first;
}

/// Returns the object at the pose that has the same number in the store and another name, which the store holds.
const Track* find_same_id(const ObjectPose& pose, const Eigen::Isometry3d& T_world_camera, const TrackModels& models,
                          const std::vector<Track>& tracks, double same_rotation_rad) {
  const PoseMeasurement measured{0, T_world_camera * *pose.T_camera_object, Covariance6::Identity()};
  const auto found = std::find_if(tracks.begin(), tracks.end(), [&](const Track& track) {
    const auto model = models.find(track.class_name);
    if (!track.is_present() || model == models.end() || model->second.object_id != pose.class_id) return false;
    return track.pose.distance(measured, model->second.symmetries, model->second.centre) <
               0.5 * model->second.box_radius_m &&
           track.pose.angle(measured, model->second.symmetries) < same_rotation_rad;
  });
  return found == tracks.end() ? nullptr : &*found;
}

/// Marks tracks that were begun at the pose of a renamed object, while results had its new name already, as duplicates.
void mark_duplicates(std::size_t renamed_index, const TrackModels& models, std::vector<Track>& tracks) {
  const Track& kept = tracks[renamed_index];
  if (kept.id <= 0 || !kept.is_present()) return;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    Track& other = tracks[i];
    if (i == renamed_index || other.class_name != kept.class_name || (other.id > 0 && other.id < kept.id)) continue;
    const double distance_m =
        kept.pose.distance({kept.pose.filter().utime(), other.pose.filter().T_world_object(), Covariance6::Identity()},
                           symmetries_of(models, kept.class_name), centre_of(models, kept.class_name));
    if (distance_m < 0.5 * radius_of(models, kept.class_name)) other.id = -1;
  }
}

}  // namespace

ModelChange find_model_change(const TrackModels& before, const TrackModels& after) {
  ModelChange change;
  for (const auto& [name, model] : before) {
    const std::string successor = model.object_id > 0 ? find_same_object(after, model) : std::string();
    if (!successor.empty()) {
      if (successor != name) change.renamed[name] = successor;
    } else if (after.count(name) == 0) {
      change.removed.insert(name);
    }
  }
  return change;
}

void retire_tracks(const std::set<std::string>& removed, double gone_log_odds, std::vector<Track>& tracks) {
  const auto is_removed = [&](const Track& track) { return removed.count(track.class_name) > 0; };
  tracks.erase(std::remove_if(tracks.begin(), tracks.end(),
                              [&](const Track& track) { return track.id == 0 && is_removed(track); }),
               tracks.end());
  for (Track& track : tracks) {
    if (!track.is_present() || !is_removed(track)) continue;
    track.deleted_utime = track.pose.filter().utime();
    track.log_odds = std::min(track.log_odds, gone_log_odds);
    track.state = TrackState::kGone;
    track.reason = "its class has left the object store";
    log_info("{} #{} is gone: {}", track.class_name, track.id, track.reason);
  }
}

void rename_tracks(const std::map<std::string, std::string>& renamed, const TrackModels& models,
                   std::vector<Track>& tracks) {
  std::vector<std::size_t> changed;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    Track& track = tracks[i];
    const auto found = renamed.find(track.class_name);
    if (found == renamed.end()) continue;
    if (track.id != 0 && track.is_present())
      log_info("{} #{} is called {} now", track.class_name, track.id, found->second);
    track.class_name = found->second;
    changed.push_back(i);
  }
  for (const std::size_t i : changed) mark_duplicates(i, models, tracks);
  tracks.erase(std::remove_if(tracks.begin(), tracks.end(), [](const Track& track) { return track.id < 0; }),
               tracks.end());
}

void rename_counts(const std::map<std::string, std::string>& renamed, std::map<std::string, int>& counts) {
  std::map<std::string, int> moved;
  for (const auto& [name, count] : counts) {
    const auto found = renamed.find(name);
    int& maximum = moved[found == renamed.end() ? name : found->second];
    maximum = std::max(maximum, count);
  }
  counts = std::move(moved);
}

void ClassNames::update(const ModelChange& change, const TrackModels& models) {
  for (auto it = renamed_.begin(); it != renamed_.end();) {
    const auto renamed_again = change.renamed.find(it->second);
    if (renamed_again != change.renamed.end()) it->second = renamed_again->second;
    const bool is_removed = change.removed.count(it->second) > 0;
    if (is_removed) removed_.insert(it->first);
    it = is_removed ? renamed_.erase(it) : std::next(it);
  }
  for (const auto& [former, name] : change.renamed) renamed_[former] = name;
  removed_.insert(change.removed.begin(), change.removed.end());
  for (const auto& [name, model] : models) {
    renamed_.erase(name);
    removed_.erase(name);
  }
}

ObjectPoses ClassNames::resolve(const FrameObservation& observation, const TrackModels& models,
                                const std::vector<Track>& tracks, double same_rotation_rad) const {
  ObjectPoses poses = observation.poses;
  poses.poses.erase(std::remove_if(poses.poses.begin(), poses.poses.end(),
                                   [&](const ObjectPose& pose) { return removed_.count(pose.class_name) > 0; }),
                    poses.poses.end());
  for (ObjectPose& pose : poses.poses) {
    const auto renamed = renamed_.find(pose.class_name);
    if (renamed != renamed_.end()) pose.class_name = renamed->second;
    if (!pose.T_camera_object || models.count(pose.class_name) > 0) continue;
    const Track* object = find_same_id(pose, observation.T_world_camera, models, tracks, same_rotation_rad);
    if (object != nullptr) pose.class_name = object->class_name;
  }
  return poses;
}

std::optional<Detections> ClassNames::resolve(const Detections& detections) const {
  if (renamed_.empty()) return std::nullopt;
  Detections resolved = detections;
  for (Detection& detection : resolved.detections) {
    const auto renamed = renamed_.find(detection.class_name);
    if (renamed != renamed_.end()) detection.class_name = renamed->second;
  }
  return resolved;
}

}  // namespace houghstream::tracks
