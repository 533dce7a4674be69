#pragma once

#include <cstdint>

#include "detector/features/tile_plane.hpp"

namespace houghstream {

/// The side of a square around each pixel; where it is even, one pixel more lies to the left and above.
struct Neighbourhood {
  int side = 1;
  int before() const { return side / 2; }
  int after() const { return side - 1 - side / 2; }
};

/// Planes of the rows that get the largest and the smallest value.
struct ExtremePlanes {
  int largest = 0;
  int smallest = 0;
};

/// Computes the largest and the smallest value around each pixel of a part, which has a margin of at least
/// `around.before()` pixels.
void byte_extremes(const TilePlane<std::uint8_t>& plane, Neighbourhood around, ExtremePlanes planes, TileRows& rows);

/// Quantisation of depth steps to bytes.
enum class StepBytes : std::uint8_t { kWrapped, kLimited };

/// Computes extremes of 16-bit values, which are quantised to bytes afterwards.
void step_extremes(const TilePlane<std::uint16_t>& plane, Neighbourhood around, StepBytes bytes, ExtremePlanes planes,
                   TileRows& rows);

}  // namespace houghstream
