#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tools/render/world/optics/shading.hpp"
#include "tools/render/world/scene_frames.hpp"
#include "tools/render/world/takes/take_stage.hpp"

namespace houghstream::world {

/// Models the exposure of an image: a rolling shutter, with motion blur.
struct Shutter {
  double exposure_s = 0.01;  ///< each row gathers light for so long
  double readout_s = 0.02;   ///< time from the first row to the last; the middle row is exposed about the frame's time
};

/// A scene motion moves the world's assets to their poses at a time in seconds, and returns the camera's pose
/// (T_camera_world).
using SceneMotion = std::function<Eigen::Isometry3d(World& world, double seconds)>;

/// Shades a moving world while the frame of time `seconds` is exposed. Geometry is that of the middle of each row's
/// exposure; radiance is blurred along each pixel's motion. Rows are exposed in bands within which motion stays below a
/// pixel. `lit_world`: assets are moved, shadows are kept.
ShadedView expose(LitWorld lit_world, const Camera& camera, const SceneMotion& motion, double seconds,
                  const Shutter& shutter);

/// Renders a recording of an object being shown, with the ground truth of every frame: a rolling shutter, motion blur,
/// automatic exposure that lags behind.
class RenderedTake {
 public:
  /// Distributes `frames` over the plan's seconds; at least 2.
  RenderedTake(const TakePlan& plan, int frames, int threads);

  /// Renders frame `index`, with its ground truth at the time of its middle row. The utime is left 0. const calls are
  /// thread-safe.
  RenderedFrame render(int index) const;

 private:
  double time_of(int index) const { return seconds_ * index / (frames_ - 1); }
  LitWorld lit_at(double seconds) const;
  void meter_light(int threads);

  TakeStage stage_;
  double seconds_;
  int frames_;
  LitWorld lit_world_;             ///< world at 0 seconds
  std::vector<double> exposures_;  ///< factor on the light, per frame
};

/// A take among those that `hs-render takes` makes.
struct NumberedTake {
  int scene = 1;  ///< N of test/00000N/; an object's takes keep their numbers, whichever others are rendered
  int take = 1;   ///< 1: upright, 2: on its side or upside down
  std::string object;
  TakePlan plan;
};

/// Returns both takes of the twelve objects of the scenes objects_20_b, _d and _f, from uniform (bowl, tumbler, teapot)
/// to textured (cartons, cans): eight before a camera that is carried round them, two on a turntable, two rotated by
/// hand. Every object has a room of its own, which both takes share. `world` names a set of rooms and movements.
std::vector<NumberedTake> twelve_objects_takes(DatasetSplit use, int world, double seconds);

}  // namespace houghstream::world
