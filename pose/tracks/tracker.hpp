#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "pipeline/base/log_throttle.hpp"
#include "pipeline/base/settings_fields.hpp"
#include "pipeline/bus/sequence_tracker.hpp"
#include "pipeline/types/frame_id.hpp"
#include "pose/tracks/association.hpp"
#include "pose/tracks/class_names.hpp"
#include "pose/tracks/existence.hpp"
#include "pose/tracks/track.hpp"

namespace houghstream::tracks {

/// Settings of the tracker and of its stages.
struct ObjectTrackerSettings {
  PoseTrackSettings pose;
  AssociationSettings association;
  ExistenceSettings existence;
  double gone_report_s = 2.0;         ///< time for which an object that is gone is still published
  double reidentification_s = 600.0;  ///< time within which an object that comes back keeps its number
  double hand_occlusion_s = 3.0;      ///< time for which an occluded object may be in a hand
  std::size_t max_objects = 500;      ///< limit of objects and candidates; further ones are refused
};

template <typename Visit>
void fields(const ObjectTrackerSettings& /*settings*/, const Visit& visit) {
  using S = ObjectTrackerSettings;
  visit(group("pose", &S::pose));
  visit(group("association", &S::association));
  visit(group("existence", &S::existence));
  visit(number("gone_report_s", &S::gone_report_s, 0, 1e6, "s"));
  visit(number("reidentification_s", &S::reidentification_s, 0, 1e6, "s"));
  visit(number("hand_occlusion_s", &S::hand_occlusion_s, 0, 1e6, "s"));
  visit(number("max_objects", &S::max_objects, 0, 1000000));
}

/// State of a camera at its last frame.
struct CameraClock {
  std::int64_t utime = 0;         ///< time of the frame on the world's clock
  std::int64_t results = 0;       ///< number of results of this frame; 0 before the first frame
  double dt_s = 0.0;              ///< time since its frame before, at most 0.1 s; 1/30 s at the first one
  std::set<std::string> classes;  ///< classes that the results of this frame have had
  std::set<std::string> missed;   ///< classes that were searched in it, and of which a track was missed
};

/// Order of a result in time: of the poses of one frame by one detector.
enum class TimeOrder {
  kNext,  ///< it is of a frame as new as its camera's last one, or newer
  kLate,  ///< it is skipped: its camera's later frames are known, or it is of an earlier run, or its time is wrong
  kReset  ///< time goes back: a new world begins with it, in which no object is known and numbers start from 1
};

/// Frame of a result that has arrived.
struct StampedFrame {
  FrameId id;
  FrameNumber number;             ///< number that its source gave it, where there is one
  std::int64_t newest_utime = 0;  ///< time of the frame of this camera that has arrived last
};

/// The clocks of a world's cameras, and the world's own clock, which continues where a camera's clock is set. Not
/// thread-safe.
class WorldClock {
 public:
  /// Classifies a result: it is used, skipped, or begins a new world. This may change the world's clock.
  /// - A time more than a second from the camera's last one is skipped until a second result confirms it, or, where it
  ///   is ahead, another camera, since a single stamp may be wrong. Confirmed and ahead: the world's clock moves on, at
  ///   most a minute. Confirmed and behind with rising numbers: the camera's clock was set back and the world
  ///   continues. Otherwise a new world begins, at once where the source was restarted.
  /// - It is of an older frame of a camera that continues: it was only delayed, and is skipped.
  /// - It is more than a second older than another camera's last one, as with clocks that disagree: throws InputError.
  ///   After thirty of them in a row the other camera has ended, and the thirtieth begins a new world.
  /// Logs set clocks and new worlds, at most once a second.
  TimeOrder classify(const StampedFrame& frame);

  /// Sets the camera's clock to this frame and returns it.
  CameraClock& set(const StampedFrame& frame);

  /// Forgets all cameras and times.
  void reset();

  /// Returns the world's clock minus the frames' utimes: 0 as long as no clock was set.
  std::int64_t offset_us() const { return offset_us_; }
  /// Returns the frames' utime of a time on the world's clock.
  std::int64_t to_camera_time(std::int64_t world_utime) const { return microseconds_between(offset_us_, world_utime); }

 private:
  struct Camera {
    CameraClock clock;
    FrameNumber number;       // number of the last frame
    double interval_s = 0.0;  // interval between the last two frames; 0 before the second
  };

  TimeOrder classify_known_camera(const Camera& camera, const StampedFrame& frame, std::int64_t utime);
  TimeOrder classify_backward_jump(const Camera& camera, const StampedFrame& frame, std::int64_t utime);
  TimeOrder classify_forward_jump(std::int64_t last_utime, const StampedFrame& frame, std::int64_t utime);
  bool confirm_jump(std::int64_t last_utime, const FrameId& frame, std::int64_t utime);
  void set_offset(std::int64_t world_utime, const FrameId& frame);
  void log_new_world(const FrameId& frame, std::int64_t last_utime);
  void warn(const std::string& line);

  std::map<std::string, Camera> cameras_;            // cameras by channel name
  std::map<std::string, std::int64_t> unconfirmed_;  // time, on the world's clock, of the last frame far from its
                                                     // camera's last one and not yet confirmed, by channel
  std::optional<FrameId> newest_;                    // newest frame of all cameras, on the world's clock
  std::int64_t offset_us_ = 0;
  int stale_results_ = 0;  // frames one after the other that were refused as too old
  LogThrottle throttle_;
};

/// Determines which classes were searched for a result, so that a class without a pose in it was missed; the result
/// does not state that itself. One detector searches all classes. Where several work on a camera's frames (two results
/// of one frame have had no class in common), a result counts for its own classes, for those that have been reported
/// together with them, and for a class whose own detector has reported nothing for a second. Poses without a model
/// belong to another host's stage and are ignored. Not thread-safe.
class SearchedClasses {
 public:
  /// Notes a result; called for each one before has_searched().
  void note(const ObjectPoses& poses);

  /// Returns whether the class was searched for this result.
  bool has_searched(const ObjectPoses& poses, const std::string& class_name) const;

  /// Forgets all other classes: an untrusted sender may make up names without end.
  void keep_only(const std::set<std::string>& classes);

 private:
  struct DetectorClasses {
    std::set<std::string> classes;  // reported in one result with it
    std::int64_t utime = 0;         // time of the last result that reports it
  };
  struct Camera {
    std::int64_t utime = 0;         // time of the last frame
    std::set<std::string> classes;  // classes of its results
    bool has_several = false;       // whether several detectors work on its frames
  };

  bool is_reporting(const std::string& class_name, std::int64_t utime) const;

  std::map<std::string, DetectorClasses> reported_with_;  // classes of a class's detector, by class name
  std::map<std::string, Camera> cameras_;                 // cameras by channel name
};

/// Tracks the objects of a world over time and over all cameras. It assigns measured poses to objects (by class, place
/// and rotation up to symmetries), estimates whether an object exists (Bayes; free space seen at its place counts
/// against it, occluded and out of view does not unless it moved), estimates where it is (MotionFilter), and gives it a
/// number (track_id).
///
/// The result of a frame follows from the frames before, in their order, and from nothing else. Not thread-safe.
class Tracker {
 public:
  /// Throws InputError for settings out of their range.
  Tracker(TrackModels models, ObjectTrackerSettings settings);

  /// Returns the world after a frame; nothing for a frame that is ignored, because it is older than its camera's last
  /// one or its stamp is wrong. When a camera's clock is set, the objects stay, and their times move with it; where a
  /// source, or its log, begins again in the past, a new world begins (WorldClock). A class that an earlier result of
  /// the frame has had is not used again. Throws InputError for a frame that is more than a second older than another
  /// camera's, while that continues.
  std::optional<WorldObjects> update(const FrameObservation& received);

  /// Returns the number of poses of the last frame that were refused (ObjectTrackerSettings::max_objects).
  std::size_t refused() const { return refused_; }

  /// Forgets all objects: they were in another coordinate frame.
  void reset();

  /// Replaces the models. Objects of a renamed class (find_model_change()) keep their number and pose under the new
  /// name, objects of a removed class are gone, all others stay.
  void set_models(TrackModels models);

 private:
  // These are the steps of update() in the order of their calls.
  CameraClock* begin_frame(const FrameObservation& received);
  std::vector<PoseObservation> observe_new_poses(const FrameObservation& observation, CameraClock& camera) const;
  std::vector<PoseObservation> associate(const std::vector<PoseObservation>& poses, double seconds);
  void update_track(Track& track, const PoseObservation& pose, double seconds);
  void update_unobserved_tracks(const FrameObservation& observation, const std::vector<PoseObservation>& poses,
                                CameraClock& camera);
  void begin_track(const PoseObservation& pose);
  bool evict_oldest();
  void confirm_tracks(std::int64_t utime);
  Track* find_reidentified(const Track& candidate, std::int64_t utime);
  void forget_tracks(std::int64_t utime);
  WorldObjects report(const FrameObservation& received, std::int64_t utime) const;

  TrackModels models_;
  ObjectTrackerSettings settings_;
  std::vector<Track> tracks_;  // tracks in the order of their creation; numbers follow in the order of confirmation
  WorldClock clock_;
  SearchedClasses searched_classes_;
  ClassNames names_;
  std::map<std::string, int> max_instances_;  // maximum number of instances in one frame, by class
  std::int64_t next_id_ = 1;
  int world_number_ = 1;     // number of the world: grows with each reset(), from which on ids begin at 1 again
  std::size_t refused_ = 0;  // poses of the last frame beyond max_objects
};

}  // namespace houghstream::tracks
