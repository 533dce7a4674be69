#include "pose/tracks/class_names.hpp"

#include <algorithm>
#include <iterator>

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

/// Returns the object that stands at the pose, has the same number in the store, and another name that the store holds.
const Track* find_namesake(const ObjectPose& pose, const Eigen::Isometry3d& T_world_camera, const TrackModels& models,
                           const std::vector<Track>& tracks, double same_rotation_rad) {
  const PoseMeasurement measured{0, T_world_camera * *pose.T_camera_object, Covariance6::Identity()};
  const auto found = std::find_if(tracks.begin(), tracks.end(), [&](const Track& track) {
    const auto model = models.find(track.class_name);
    if (!track.there() || model == models.end() || model->second.object_id != pose.class_id) return false;
    return track.pose.distance(measured, model->second.symmetries, model->second.centre) <
               0.5 * model->second.box_radius_m &&
           track.pose.angle(measured, model->second.symmetries) < same_rotation_rad;
  });
  return found == tracks.end() ? nullptr : &*found;
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

void ClassNames::update(const ModelChange& change, const TrackModels& models) {
  for (auto it = renamed_.begin(); it != renamed_.end();) {
    const auto again = change.renamed.find(it->second);
    if (again != change.renamed.end()) it->second = again->second;
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

ObjectPoses ClassNames::resolve(const FrameObservation& seen, const TrackModels& models,
                                const std::vector<Track>& tracks, double same_rotation_rad) const {
  ObjectPoses poses = seen.poses;
  poses.poses.erase(std::remove_if(poses.poses.begin(), poses.poses.end(),
                                   [&](const ObjectPose& pose) { return removed_.count(pose.class_name) > 0; }),
                    poses.poses.end());
  for (ObjectPose& pose : poses.poses) {
    const auto renamed = renamed_.find(pose.class_name);
    if (renamed != renamed_.end()) pose.class_name = renamed->second;
    if (!pose.T_camera_object || models.count(pose.class_name) > 0) continue;
    const Track* namesake = find_namesake(pose, seen.T_world_camera, models, tracks, same_rotation_rad);
    if (namesake != nullptr) pose.class_name = namesake->class_name;
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
