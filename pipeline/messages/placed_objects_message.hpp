#pragma once

#include <houghstream/placed_objects_t.hpp>

#include "pipeline/types/placed_objects.hpp"

namespace houghstream {

houghstream::placed_objects_t to_message(const ObjectPlacements& placed);

/// Throws InputError where a pose is none, or a size negative or not finite.
ObjectPlacements placed_objects_from_message(const houghstream::placed_objects_t& message);

}  // namespace houghstream
