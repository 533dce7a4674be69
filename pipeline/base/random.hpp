#pragma once

#include <cmath>
#include <cstdint>

namespace houghstream {

/// Generates random numbers by SplitMix64 (Steele, Lea, Flood 2014): it is tiny, seeded, and the same on every machine
/// and library, which the distributions of <random> do not promise.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  /// Returns an independent stream for item `index` of a parallel loop.
  static Random for_item(std::uint64_t seed, std::uint64_t index) {
    Random mixer(seed ^ (index + 1) * 0x9E3779B97F4A7C15ULL);
    return Random(mixer.bits());
  }

  std::uint64_t bits() {
    state_ += 0x9E3779B97F4A7C15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31U);
  }

  /// Returns a number in [0, 1).
  double uniform() { return static_cast<double>(bits() >> 11U) * 0x1.0p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Returns a number in [0, count); count must be positive.
  int below(int count) { return static_cast<int>(uniform() * count); }
  /// Returns a number in [low, high].
  int between(int low, int high) { return low + below(high - low + 1); }
  /// Returns a standard normal number (sum of twelve uniforms: no library function whose last bit differs between
  /// machines).
  double normal() {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) sum += uniform();
    return sum;
  }

 private:
  std::uint64_t state_;
};

}  // namespace houghstream
