#pragma once

#include <cstdint>

#include "pipeline/base/random.hpp"

namespace houghstream::world {

/// Split of the rendered worlds.
enum class DatasetSplit : std::uint8_t { kTraining, kTest };

/// Returns the seed of a world. This is the one rule that keeps training and test apart: every seed of a room, texture,
/// light or distractor comes from here, and the seeds of training worlds are even, those of test worlds odd. So no two
/// of them coincide.
inline std::uint64_t world_seed(DatasetSplit use, std::uint64_t number) {
  const std::uint64_t mixed = Random::for_item(0x486f756768ULL, number).bits();
  return (mixed & ~1ULL) | (use == DatasetSplit::kTest ? 1ULL : 0ULL);
}

/// Returns the seed of one `aspect` (object on the table, wall, light ...) of a world; it is even or odd as the world's
/// own.
inline std::uint64_t aspect_seed(std::uint64_t seed_of_world, std::uint64_t aspect) {
  const std::uint64_t mixed = Random::for_item(seed_of_world, aspect).bits();
  return (mixed & ~1ULL) | (seed_of_world & 1ULL);
}

}  // namespace houghstream::world
