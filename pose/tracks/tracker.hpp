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
#include "pipeline/bus/sequence_count.hpp"
#include "pipeline/types/frame_id.hpp"
#include "pose/tracks/association.hpp"
#include "pose/tracks/class_names.hpp"
#include "pose/tracks/existence.hpp"
#include "pose/tracks/track.hpp"

namespace houghstream::tracks {

struct ObjectTrackerSettings {
  PoseTrackSettings pose;
  AssociationSettings association;
  ExistenceSettings existence;
  double gone_report_s = 2.0;         ///< what is gone is published for so long
  double reidentification_s = 600.0;  ///< what comes back within this time keeps its number
  double hand_occlusion_s = 3.0;      ///< what a hand hides for so long may be in the hand
  std::size_t max_objects = 500;      ///< and candidates; further ones are refused
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

/// When a camera looked last.
struct CameraClock {
  std::int64_t utime = 0;         ///< on the world's clock
  std::int64_t results = 0;       ///< of the frame of this time; none before the first frame
  double seconds = 0.0;           ///< from the frame before to the one of this time, as far as they count
  std::set<std::string> classes;  ///< that the frame of this time was told of
  std::set<std::string> missed;   ///< that have been looked for in it, and of which something was not found
};

/// What a result's time says of it.
enum class TimeOrder {
  kNext,  ///< of a frame as new as its camera's last one, or newer
  kLate,  ///< to be passed over: its camera's later frames are known, or it is of an earlier run, or its time is wrong
  kAnew   ///< time goes back: a new world begins with it
};

/// A frame whose result has come.
struct StampedFrame {
  FrameId id;
  FrameNumber number;             ///< of its source, as far as that says one
  std::int64_t newest_utime = 0;  ///< of the frame of this camera that has come last
};

/// The clocks of a world's cameras, and the world's own, which goes on where theirs are set. Not thread-safe.
class WorldClock {
 public:
  /// A result whose time lies more than a second from its camera's last one is passed over until the next one, or
  /// another camera's, lies beside it: one wrong stamp is nobody's time. Then, where it is ahead, time has passed (a
  /// minute at most). Where it is behind and the frames' numbers go on, the camera's clock was set back and the world
  /// goes on; else a new world begins, at once where the numbers tell that the source was started again. Of an older
  /// frame whose camera goes on, the result has only taken long. Throws InputError for a frame that is more than a
  /// second older than another camera's, as clocks that disagree make it; where thirty have come one after the other,
  /// the other camera is no more, and the thirtieth is the beginning of a new world. Steps and new worlds are said,
  /// once a second at most.
  TimeOrder order_of(const StampedFrame& frame);

  /// The camera's clock, set to this frame.
  CameraClock& set(const StampedFrame& frame);

  /// No camera has looked yet.
  void begin_world();

  /// The world's clock minus the frames' utimes: 0 as long as no clock was set.
  std::int64_t ahead_us() const { return ahead_us_; }

 private:
  struct Camera {
    CameraClock clock;
    FrameNumber number;       // of the last frame
    double interval_s = 0.0;  // from the frame before to the last one; 0 before the second
  };

  TimeOrder order_after(const Camera& camera, const StampedFrame& frame, std::int64_t utime);
  TimeOrder order_behind(const Camera& camera, const StampedFrame& frame, std::int64_t utime);
  TimeOrder order_ahead(std::int64_t last_utime, const StampedFrame& frame, std::int64_t utime);
  bool is_confirmed(std::int64_t last_utime, const FrameId& frame, std::int64_t utime);
  void move_to(std::int64_t world_utime, const FrameId& frame);
  void tell_new_world(const FrameId& frame, std::int64_t last_utime);
  void warn(const std::string& line);

  std::map<std::string, Camera> cameras_;        // by channel
  std::map<std::string, std::int64_t> doubted_;  // by channel, the time that lies far from the camera's last one
  std::optional<FrameId> newest_;                // of all cameras, on the world's clock
  std::int64_t ahead_us_ = 0;
  int behind_ = 0;  // frames one after the other that were refused as too old
  LogThrottle lines_;
};

/// Which classes a result speaks of, by having no pose of them. It does not say what was looked for: of one detector it
/// is everything. Where several work on a camera's frames (two results of one frame have had no class in common), a
/// result speaks of its own classes and of those that have been told of together with them, and of one whose own
/// detector has told nothing for a second. Poses without a model are somebody else's. Not thread-safe.
class SearchedClasses {
 public:
  /// To be told of each result, before it is asked about it.
  void note(const ObjectPoses& poses);

  bool has_searched(const ObjectPoses& poses, const std::string& class_name) const;

  /// Forgets all other classes: a sender of rubbish may make up names without end.
  void keep_only(const std::set<std::string>& classes);

 private:
  struct Coverage {
    std::set<std::string> classes;  // that were told of in one result with it
    std::int64_t utime = 0;         // when it was told of last
  };
  struct Camera {
    std::int64_t utime = 0;         // of the last frame
    std::set<std::string> classes;  // that it was told of
    bool has_several = false;       // detectors
  };

  bool is_reporting(const std::string& class_name, std::int64_t utime) const;

  std::map<std::string, Coverage> companies_;  // by class
  std::map<std::string, Camera> cameras_;      // by channel
};

/// The objects of a world, over time and over all cameras: which measured pose is of which object (class, place,
/// rotation but for symmetries), whether an object is there (Bayes, with the evidence of depth against it: seen through
/// is gone, hidden and out of view is kept unless it moved), where it is (MotionFilter), and which number it has.
///
/// A frame's result follows from the frames before, in their order, and nothing else. Not thread-safe.
class Tracker {
 public:
  /// Throws InputError for settings out of their range.
  Tracker(TrackModels models, ObjectTrackerSettings settings);

  /// The world after a frame. One that is older than its camera's last one is late, is passed over, and gives nothing;
  /// so does one wrong stamp. A camera's clock that is set leaves the objects what they are, and their times move with
  /// it; where a source, or its log, begins again in the past, a new world begins (WorldClock). A class that the same
  /// frame was told of before is not told again. Throws InputError for a frame that is more than a second older than
  /// another camera's, as long as that goes on.
  std::optional<WorldObjects> update(const FrameObservation& received);

  /// Poses of the last frame of objects for which there was no room (ObjectTrackerSettings::max_objects).
  std::size_t refused() const { return refused_; }

  /// Forgets all objects: they were in another coordinate frame.
  void begin_world();

  /// Other models from here on. Objects of a class that is renamed (find_model_change()) keep their number and pose
  /// under the new name, objects of a class that is removed are gone, all others stay.
  void set_models(TrackModels models);

 private:
  // The steps of update() in the order of their calls.
  CameraClock* begin_frame(const FrameObservation& received);
  std::vector<PoseObservation> observe_new_poses(const FrameObservation& seen, CameraClock& camera) const;
  std::vector<PoseObservation> associate(const std::vector<PoseObservation>& poses, double seconds);
  void update_track(Track& track, const PoseObservation& pose, double seconds);
  void update_unobserved_tracks(const FrameObservation& seen, const std::vector<PoseObservation>& poses,
                                CameraClock& camera);
  void begin_track(const PoseObservation& pose);
  bool make_room();
  void confirm_tracks(std::int64_t utime);
  Track* find_reidentified(const Track& candidate, std::int64_t utime);
  void forget_tracks(std::int64_t utime);
  WorldObjects report(const FrameObservation& received, std::int64_t utime) const;

  TrackModels models_;
  ObjectTrackerSettings settings_;
  std::vector<Track> tracks_;  // by when they were begun; numbers follow in the order of confirmation
  WorldClock clock_;
  SearchedClasses searched_classes_;
  ClassNames names_;
  std::map<std::string, int> max_instances_;  // by class: instances that were seen in one frame
  std::int64_t next_id_ = 1;
  int world_number_ = 1;
  std::size_t refused_ = 0;  // poses of the last frame, for which there was no room
};

}  // namespace houghstream::tracks
