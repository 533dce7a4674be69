#pragma once

#include "detector/forest/forest.hpp"

namespace houghstream {

/// Over how many times as many views a class is spread as if it had been taught upright only: all its views over those
/// that look at it from the side or from above with its z axis upwards in the picture. 1 where nearly all do, as on
/// a turntable; at most 4.
float attitude_spread(const Forest& forest, std::uint32_t class_index);

}  // namespace houghstream
