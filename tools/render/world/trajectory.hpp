#pragma once

#include <Eigen/Geometry>
#include <cstdint>

namespace houghstream::world {

/// Describes a camera carried by hand along an arc round a table: azimuth sweeps once, height and distance swing.
struct Trajectory {
  double azimuth_start_rad = 0.0;  ///< azimuth of the camera seen from the target; 0 = from -y, positive towards +x
  double azimuth_end_rad = 0.0;
  double elevation_rad = 0.5;  ///< above the horizon, on average
  double elevation_swing_rad = 0.15;
  double distance_m = 1.4;  ///< mean distance from camera to target
  double distance_swing_m = 0.35;
  double phase_rad = 0.0;  ///< phase of the swings
};

/// Makes a path that suits a table. It is deterministic for a seed.
Trajectory make_trajectory(std::uint64_t seed);

/// Returns the camera's pose at `time`, 0 (first frame) to 1 (last).
Eigen::Isometry3d camera_at(const Trajectory& trajectory, double time);

}  // namespace houghstream::world
