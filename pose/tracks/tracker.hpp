#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "pipeline/types/detection.hpp"
#include "pose/tracks/track.hpp"

namespace houghstream::tracks {

/// Which measured pose is of which object.
struct AssociationSettings {
  double reach_m = 0.06;         ///< of what stands
  double moving_reach_m = 0.12;  ///< of what moves
  double turn_cost = 0.5;        ///< of half a turn beside that of the whole reach
  double crowded = 0.6;          ///< radii within which no second object of a class can be
};

/// Whether an object is there: log odds that grow and fall with what is seen. Rates are per second of a camera's
/// frames: frames that follow one another closely show the same errors and say little new.
struct ExistenceSettings {
  double prior = -1.5;         ///< of what was never seen before
  double gain = 0.5;           ///< of a pose's own log odds, at 30 Hz
  double most = 6.0;           ///< however often it was seen
  double confirmed = 2.2;      ///< published from here on,
  int confirmed_frames = 3;    ///< seen in so many frames,
  double confirmed_s = 0.08;   ///< so long apart
  double gone = -1.0;          ///< below it is gone
  double seen_through = 30.0;  ///< a second, where the camera sees through it
  double crowded_out = 12.0;   ///< a second, where another class is recognised in its place
  double goes_on = 3.0;        ///< a second, where depth agrees but the surface is larger
  double unrecognised = 0.6;   ///< a second, where depth agrees but nothing is recognised
  double lost = 14.0;          ///< a second, where it moved when it was seen last; hidden, a quarter of it
  double unconfirmed = 4.0;    ///< a second, of what is not yet published and not seen
};

struct TrackerSettings {
  PoseTrackSettings pose;
  AssociationSettings association;
  ExistenceSettings existence;
  double told_gone_s = 2.0;        ///< what is gone is published for so long
  double remembered_s = 600.0;     ///< what comes back within this time keeps its number
  double handled_s = 3.0;          ///< what a hand hides for so long may be in the hand
  std::size_t most_objects = 500;  ///< and candidates; further ones are refused
};

/// What is known of a frame of a camera.
struct FrameSeen {
  const ObjectPoses& poses;                ///< names the frame
  const Detections* detections = nullptr;  ///< of the frame, where they are known
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  std::function<const RgbdFrame*()> image;  ///< its depth, asked only where that is needed; null where there is none
  /// Of the frame of this camera that has come last: without it, the frame of the poses.
  std::optional<std::int64_t> newest_utime = std::nullopt;
};

/// The objects of a world, over time and over all cameras: which measured pose is of which object (class, place,
/// rotation but for symmetries), whether an object is there (Bayes, with the evidence of depth against it: seen through
/// is gone, hidden and out of view is kept unless it moved), where it is (MotionFilter), and which number it has.
///
/// A frame's result follows from the frames before, in their order, and nothing else. Not thread-safe.
class Tracker {
 public:
  Tracker(TrackModels models, TrackerSettings settings);
  ~Tracker();
  Tracker(Tracker&&) noexcept;

  /// The world after a frame. One that is older than its camera's last one is late, is passed over, and gives nothing;
  /// where the camera's frames themselves go back by more than a second, a new world begins. A class that the same
  /// frame was told of before is not told again. Throws InputError for a frame that is more than a second older than
  /// another camera's, as long as that goes on.
  std::optional<WorldObjects> update(const FrameSeen& seen);

  /// Poses of the last frame of objects for which there was no room (TrackerSettings::most_objects).
  std::size_t refused() const;

  /// Forgets all objects: they were in another coordinate frame.
  void begin_world();

  /// Other models from here on; the objects stay.
  void set_models(TrackModels models);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace houghstream::tracks
