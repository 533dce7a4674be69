#pragma once

#include <vector>

#include "tools/render/world/objects/objects.hpp"
#include "tools/render/world/rooms/attitudes.hpp"
#include "tools/render/world/scene_frames.hpp"

namespace houghstream::world {

/// Settings of training views as in the paper's Section 4 (and Lai et al. 2011): an object on a turntable in front of a
/// fixed camera, all round at several pitches; for each way of lying in steps twice as long.
struct TurntableSettings {
  int azimuths = 36;  ///< steps of a full turn
  int pitches = 3;    ///< camera heights, evenly spread over lowest to highest
  double lowest_pitch_deg = 30.0;
  double highest_pitch_deg = 60.0;
  double distance_m = 0.7;                                 ///< camera to object
  std::vector<Attitude> attitudes = {Attitude::kUpright};  ///< each at most once
};

/// Holds a training room with an empty turntable; one for each pitch, since light changes between recordings.
class TurntableWorld {
 public:
  TurntableWorld(const TurntableSettings& settings, std::uint64_t seed);

  /// Returns the number of views over all attitudes; `choice` may be null if none of them is lying.
  int view_count(const AttitudeChoice* choice) const;

  /// Renders view `index` (attitude by attitude, pitch by pitch, azimuth by azimuth) of an object, with its ground
  /// truth. utime is left 0. `choice` is of the object; it may be null where all views are upright.
  RenderedFrame render(const TaughtObject& object, const AttitudeChoice* choice, int index) const;

 private:
  int azimuths(Attitude attitude, const AttitudeChoice* choice) const;

  TurntableSettings settings_;
  std::uint64_t seed_;
  std::vector<World> worlds_;  ///< one per pitch
};

}  // namespace houghstream::world
