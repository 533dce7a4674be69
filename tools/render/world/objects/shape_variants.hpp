#pragma once

#include "pipeline/base/random.hpp"
#include "tools/render/world/objects/asset.hpp"

// Variants of a taught object.

namespace houghstream::world {

/// Makes an instance of the object that still counts as the object: up to 1.5 % larger or smaller, and smoothly
/// deformed by up to 3 mm or 2 % of its size, root mean square. A mesh is a scan or a drawing of one instance; scanners
/// err by millimetres, and instances are filled, pressed and handled differently. The ranges were chosen for this
/// project.
AssetPtr make_instance_variant(const Asset& thing, Random& random);

/// Makes another object: clearly smaller or larger, of other proportions, or in other colours and often with another
/// texture, as other packages are.
AssetPtr make_hard_negative(const Asset& thing, Random& random);

}  // namespace houghstream::world
