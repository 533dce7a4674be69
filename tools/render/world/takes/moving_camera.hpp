#pragma once

#include <functional>

#include "tools/render/world/optics/shading.hpp"

namespace houghstream::world {

/// How a picture is exposed: the rows one after the other (a rolling shutter), each for a while (motion blur).
struct Shutter {
  double exposure_s = 0.01;  ///< each row gathers light for so long
  double readout_s = 0.02;   ///< from the first row to the last; the middle row is exposed about the frame's time
};

/// What moves, at a time in seconds: puts the world's things where they are then, and says where the camera is
/// (T_camera_world).
using Motion = std::function<Eigen::Isometry3d(World& world, double seconds)>;

/// What each pixel sees of a world in motion while the frame of time `seconds` is exposed. Geometry is that of the
/// middle of each row's exposure; radiance is smeared along each pixel's own way. Rows are exposed in bands, within
/// which motion stays below a pixel. `lit_world`: shadows are kept as they are, things are moved.
ShadedView expose(LitWorld lit_world, const Camera& camera, const Motion& motion, double seconds,
                  const Shutter& shutter);

}  // namespace houghstream::world
