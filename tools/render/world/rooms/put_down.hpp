#pragma once

#include <vector>

#include "pipeline/base/random.hpp"
#include "tools/render/world/objects/world.hpp"

// These put assets down otherwise than upright, alone or on a support: groups that belong together. Group frame: z up,
// z = 0 on the table, origin within the group; `T_world_object` of a group's members maps into it.

namespace houghstream::world {

using AssetGroup = std::vector<PlacedAsset>;

/// Puts the asset down on a side or upside down; `random` selects the attitude. Throws InputError where it has none.
AssetGroup put_lying(const AssetPtr& thing, int object_id, Random& random);

/// Puts the asset on a wedge of 12 to 20 degrees, in a stable pose (upright included) in which it neither tips over nor
/// rolls off. Throws InputError where it has none.
AssetGroup put_on_wedge(const AssetPtr& thing, int object_id, Random& random);

/// Returns half the sides of the rectangle about the group's origin over which its members reach, metres.
Eigen::Vector2d half_extent(const AssetGroup& group);

}  // namespace houghstream::world
