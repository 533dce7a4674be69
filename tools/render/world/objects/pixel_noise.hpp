#pragma once

#include <cstdint>

#include "pipeline/base/random.hpp"

namespace houghstream::world {

/// Returns true with the given probability.
inline bool chance(Random& random, double probability) {
  return random.uniform() < probability;
}

/// Returns one of a container's elements.
template <typename Container>
const auto& pick(Random& random, const Container& choices) {
  return choices[static_cast<std::size_t>(random.below(static_cast<int>(choices.size())))];
}

/// Returns a nearly normal number (sum of four uniforms, mean 0, deviation 1) for pixel `index` of noise field `seed`:
/// per-pixel noise that does not depend on the order in which pixels are visited.
inline float pixel_normal(std::uint64_t seed, std::uint64_t index) {
  const std::uint64_t bits = Random(seed + index * 0xd1342543de82ef95ULL).bits();
  const auto sum =
      static_cast<float>((bits & 0xffffU) + ((bits >> 16U) & 0xffffU) + ((bits >> 32U) & 0xffffU) + (bits >> 48U));
  constexpr float kMean = 131070.0F;      // mean of the sum of four uniforms on 0..65535
  constexpr float kDeviation = 37837.2F;  // 65536 / sqrt(3)
  return (sum - kMean) / kDeviation;
}

/// Returns a uniform number in [0,1) for pixel `index` of noise field `seed`.
inline float pixel_uniform(std::uint64_t seed, std::uint64_t index) {
  return static_cast<float>(Random(seed + index * 0xd1342543de82ef95ULL).bits() >> 40U) * (1.0F / 16777216.0F);
}

}  // namespace houghstream::world
