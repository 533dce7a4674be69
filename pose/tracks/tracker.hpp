#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "pipeline/base/settings_fields.hpp"
#include "pose/tracks/association.hpp"
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

/// The objects of a world, over time and over all cameras: which measured pose is of which object (class, place,
/// rotation but for symmetries), whether an object is there (Bayes, with the evidence of depth against it: seen through
/// is gone, hidden and out of view is kept unless it moved), where it is (MotionFilter), and which number it has.
///
/// A frame's result follows from the frames before, in their order, and nothing else. Not thread-safe.
class Tracker {
 public:
  /// Throws InputError for settings out of their range.
  Tracker(TrackModels models, ObjectTrackerSettings settings);
  ~Tracker();
  Tracker(Tracker&&) noexcept;

  /// The world after a frame. One that is older than its camera's last one is late, is passed over, and gives nothing;
  /// so does one wrong stamp. A camera's clock that is set leaves the objects what they are, and their times move with
  /// it; where a source, or its log, begins again in the past, a new world begins (WorldClock). A class that the same
  /// frame was told of before is not told again. Throws InputError for a frame that is more than a second older than
  /// another camera's, as long as that goes on.
  std::optional<WorldObjects> update(const FrameObservation& seen);

  /// Poses of the last frame of objects for which there was no room (ObjectTrackerSettings::max_objects).
  std::size_t refused() const;

  /// Forgets all objects: they were in another coordinate frame.
  void begin_world();

  /// Other models from here on. Objects of a class that is renamed (find_model_change()) keep their number and pose
  /// under the new name, objects of a class that is removed are gone, all others stay.
  void set_models(TrackModels models);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace houghstream::tracks
