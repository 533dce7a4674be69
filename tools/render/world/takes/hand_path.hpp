#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "pipeline/base/random.hpp"

namespace houghstream::world {

/// A number that sways about 0, as a hand does that is to be held still: sines whose amplitude falls with their
/// frequency. Deterministic, smooth, and known at any time.
class Wander {
 public:
  /// Frequencies in hertz, from slow to fast; `deviation` is the standard deviation over a long time.
  Wander(double slowest_hz, double fastest_hz, double deviation, Random& random) {
    double power = 0.0;
    for (Sine& sine : sines_) {
      const double hz = slowest_hz * std::pow(fastest_hz / slowest_hz, random.uniform());
      sine = {2.0 * M_PI * hz, random.uniform(0.0, 2.0 * M_PI), 1.0 / hz};
      power += 0.5 * sine.amplitude * sine.amplitude;
    }
    for (Sine& sine : sines_) sine.amplitude *= deviation / std::sqrt(power);
  }

  double at(double seconds) const {
    double sum = 0.0;
    for (const Sine& sine : sines_) sum += sine.amplitude * std::sin(sine.rad_per_s * seconds + sine.phase_rad);
    return sum;
  }

 private:
  struct Sine {
    double rad_per_s = 0.0;
    double phase_rad = 0.0;
    double amplitude = 0.0;
  };
  std::array<Sine, 5> sines_{};
};

/// A movement from 0 to 1 as a person makes it: it starts and ends gently, hurries and dawdles between. Monotonic.
class UnevenProgress {
 public:
  UnevenProgress(double seconds, std::uint64_t seed);
  double at(double seconds) const;  ///< 0 before the start, 1 after the end

 private:
  double seconds_;
  std::vector<double> done_;  ///< at even steps of time
};

/// Settings of the path of a camera carried by hand.
struct HandPathSettings {
  double seconds = 16.0;
  double angle_rad = 6.6;    ///< round the target; a little more than a turn, so that the end meets the start
  double distance_m = 0.65;  ///< mean distance to the target
  Eigen::Vector3d target_world = Eigen::Vector3d(0.0, 0.0, 0.05);
};

/// Simulates a camera carried by hand round one object: height and distance swing, the aim wanders, the hand shakes.
/// World frame as in world.hpp.
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
  std::vector<Wander> shift_;    ///< shift of the eye, metres
  std::vector<Wander> tremble_;  ///< rotation of the camera's axes, radians
};

}  // namespace houghstream::world
