#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "tools/render/world/takes/wander.hpp"

namespace houghstream::world {

/// A movement from 0 to 1 as a person makes it: it starts and ends gently, hurries and dawdles between. Monotonic.
class UnevenProgress {
 public:
  UnevenProgress(double seconds, std::uint64_t seed);
  double at(double seconds) const;  ///< 0 before the start, 1 after the end

 private:
  double seconds_;
  std::vector<double> done_;  ///< at even steps of time
};

/// Where somebody walks a camera.
struct HandPathSettings {
  double seconds = 16.0;
  double turn_rad = 6.6;     ///< round the target; a little more than a turn, so that the end meets the start
  double distance_m = 0.65;  ///< to the target, on average
  Eigen::Vector3d target_world = Eigen::Vector3d(0.0, 0.0, 0.05);
};

/// A camera carried by hand round one object: height and distance swing, the aim wanders, the hand shakes. World frame
/// as in world.hpp.
class HandPath {
 public:
  HandPath(const HandPathSettings& settings, std::uint64_t seed);
  Eigen::Isometry3d T_camera_world(double seconds) const;

 private:
  HandPath(const HandPathSettings& settings, std::uint64_t seed, Random random);

  HandPathSettings settings_;
  UnevenProgress progress_;
  double start_rad_;
  double direction_;
  double elevation_rad_;
  double elevation_swing_rad_;
  double swing_phase_rad_;
  Wander elevation_drift_, distance_drift_, roll_;
  std::vector<Wander> aim_;      ///< metres, along x, y, z
  std::vector<Wander> shift_;    ///< of the eye, metres
  std::vector<Wander> tremble_;  ///< of the camera's axes, radians
};

}  // namespace houghstream::world
