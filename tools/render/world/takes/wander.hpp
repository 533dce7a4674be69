#pragma once

#include <array>
#include <cmath>

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

}  // namespace houghstream::world
