#pragma once

#include <vector>

#include "tools/render/world/scene_frames.hpp"
#include "tools/render/world/takes/moving_camera.hpp"
#include "tools/render/world/takes/take_stage.hpp"

namespace houghstream::world {

/// A recording of an object being shown, with the truth of every frame: a rolling shutter, motion blur, automatic
/// exposure that lags behind.
class Take {
 public:
  /// `frames` over the plan's seconds, at least 2.
  Take(const TakePlan& plan, int frames, int threads);

  /// Frame `index`, with its truth at the time of its middle row. The utime is left 0. const calls are thread-safe.
  RenderedFrame render(int index) const;

 private:
  double time_of(int index) const { return seconds_ * index / (frames_ - 1); }
  LitWorld lit_at(double seconds) const;
  void meter_light(int threads);

  TakeStage stage_;
  double seconds_;
  int frames_;
  LitWorld lit_world_;             ///< at 0 seconds
  std::vector<double> exposures_;  ///< factor on the light, per frame
};

}  // namespace houghstream::world
