#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "pose/tracks/track.hpp"

namespace houghstream::tracks {

/// Difference between two states of an object store, as a tracker sees it.
struct ModelChange {
  std::map<std::string, std::string> renamed;  ///< new name by the former one
  std::set<std::string> removed;               ///< names of classes that have no successor
};

/// Compares the models before and after a change. A class is renamed where the object of its number in the store has
/// the same mesh under another name; one without a number is never renamed, only removed.
ModelChange find_model_change(const TrackModels& before, const TrackModels& after);

/// Deletes the tracks of removed classes: objects are reported as gone from here on, and candidates are removed.
/// `gone_log_odds`: ExistenceSettings::delete_log_odds.
void retire_tracks(const std::set<std::string>& removed, double gone_log_odds, std::vector<Track>& tracks);

/// Gives objects the new names of their classes. Tracks that were begun at their poses, while results had the new names
/// already, are removed.
void rename_tracks(const std::map<std::string, std::string>& renamed, const TrackModels& models,
                   std::vector<Track>& tracks);

/// Moves counts by class to the new names; of two that become one the larger stays.
void rename_counts(const std::map<std::string, std::string>& renamed, std::map<std::string, int>& counts);

/// Translates class names across changes of the object store. Detector and pose estimator adopt a change a moment
/// before or after the tracker, so that results may use the old or the new name. Not thread-safe.
class ClassNames {
 public:
  /// Notes a change that has led to these models.
  void update(const ModelChange& change, const TrackModels& models);

  /// Returns the poses under the current names, without those of classes that have left the store. A valid pose whose
  /// name the store does not hold is assigned to the object at its position that has the same number in the store: the
  /// new name will arrive soon.
  ObjectPoses resolve(const FrameObservation& observation, const TrackModels& models, const std::vector<Track>& tracks,
                      double same_rotation_rad) const;

  /// Returns the detections under the current names; nothing where they have these already.
  std::optional<Detections> resolve(const Detections& detections) const;

 private:
  std::map<std::string, std::string> renamed_;  // current names by former ones
  std::set<std::string> removed_;
};

}  // namespace houghstream::tracks
