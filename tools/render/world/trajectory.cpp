#include "tools/render/world/trajectory.hpp"

#include <cmath>

#include "pipeline/base/random.hpp"
#include "tools/render/world/objects/world.hpp"

namespace houghstream::world {

Trajectory make_trajectory(std::uint64_t seed) {
  Random random(seed);
  Trajectory trajectory;
  const double middle = random.uniform(-0.25, 0.25);
  const double half_sweep = random.uniform(0.6, 0.95) * (random.uniform() < 0.5 ? -1.0 : 1.0);
  trajectory.azimuth_start_rad = middle - half_sweep;
  trajectory.azimuth_end_rad = middle + half_sweep;
  trajectory.elevation_rad = random.uniform(0.5, 0.68);
  trajectory.elevation_swing_rad = random.uniform(0.08, 0.16);
  trajectory.distance_m = random.uniform(1.3, 1.5);
  trajectory.distance_swing_m = random.uniform(0.3, 0.42);
  trajectory.phase_rad = random.uniform(0.0, 2.0 * M_PI);
  return trajectory;
}

Eigen::Isometry3d camera_at(const Trajectory& trajectory, double time) {
  // Hands start and stop gently, and never hold quite still.
  const double eased = time * time * (3.0 - 2.0 * time);
  const double phase = trajectory.phase_rad;
  const double azimuth =
      trajectory.azimuth_start_rad + (trajectory.azimuth_end_rad - trajectory.azimuth_start_rad) * eased;
  const double elevation =
      trajectory.elevation_rad + trajectory.elevation_swing_rad * std::sin(2.0 * M_PI * 0.9 * time + phase);
  const double distance =
      trajectory.distance_m + trajectory.distance_swing_m * std::sin(2.0 * M_PI * 1.3 * time + 2.0 * phase);
  const Eigen::Vector3d target(0.06 * std::sin(5.0 * time + phase), 0.05 * std::cos(4.0 * time + phase),
                               0.06 + 0.02 * std::sin(9.0 * time));
  const Eigen::Vector3d sway(0.006 * std::sin(31.0 * time + phase), 0.006 * std::sin(37.0 * time),
                             0.005 * std::sin(43.0 * time));
  const Eigen::Vector3d from_target(std::sin(azimuth) * std::cos(elevation), -std::cos(azimuth) * std::cos(elevation),
                                    std::sin(elevation));
  return look_at(target + distance * from_target + sway, target);
}

}  // namespace houghstream::world
