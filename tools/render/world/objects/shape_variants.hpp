#pragma once

#include "pipeline/base/random.hpp"
#include "tools/render/world/objects/asset.hpp"

// What is like a taught object and is not quite it.

namespace houghstream::world {

/// The same object to everybody who looks for it: up to 1.5 % larger or smaller, and bent smoothly by up to 3 mm or 2 %
/// of its size, root of the mean square. A mesh is a scan or a drawing of one thing; scanners err by
/// millimetres, and the next thing was filled, pressed and handled otherwise. How widely is ours.
AssetPtr make_instance_variant(const Asset& thing, Random& random);

/// Another object: clearly smaller or larger, of other proportions, or in other colours and often with another print,
/// as other packages are.
AssetPtr make_hard_negative(const Asset& thing, Random& random);

}  // namespace houghstream::world
