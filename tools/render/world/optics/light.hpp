#pragma once

#include "tools/render/world/objects/world.hpp"

namespace houghstream::world {

enum class TimeOfDay : std::uint8_t { kDay, kEvening };

/// Sets a lamp or window and a weak overhead light, ambient light, and the camera's image settings. In the evening they
/// are weaker and warmer, and the image is darker and noisier.
void set_lighting(World& world, TimeOfDay time, std::uint64_t seed);

}  // namespace houghstream::world
