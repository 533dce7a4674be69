#pragma once

#include "tools/render/world/rooms/put_down.hpp"

namespace houghstream::world {

/// Tilt of leaning objects, degrees from a stable pose.
inline constexpr double kMinLeanDeg = 10.0;
inline constexpr double kMaxLeanDeg = 60.0;

/// Leans the asset on a block: it is tilted by 10 to 60 degrees from a stable pose (upright in half of the cases), its
/// lowest point on the table, the block's upper edge at its underside, its centre of mass between the two. The group's
/// first member is the block. Throws InputError where no such attitude is found.
AssetGroup put_leaning(const AssetPtr& thing, int object_id, Random& random);

}  // namespace houghstream::world
