#pragma once

#include "pipeline/base/random.hpp"
#include "tools/render/world/objects/asset.hpp"

// These are the sixteen further classes (ids 101 to 116), by family. Sizes and colours are fixed, the generator only
// draws textures. Each is finished: origin at the centre of its bounding box, z up, front to -y.

namespace houghstream::world {

// These make tableware.
AssetPtr make_plate(Random& random);    ///< plain with a coloured rim
AssetPtr make_teapot(Random& random);   ///< one colour
AssetPtr make_pitcher(Random& random);  ///< enamel
AssetPtr make_tumbler(Random& random);  ///< one colour with bands

// These make containers.
AssetPtr make_water_bottle(Random& random);
AssetPtr make_shampoo_bottle(Random& random);  ///< oval
AssetPtr make_jam_jar(Random& random);
AssetPtr make_food_tin(Random& random);

// These make packages and desk items.
AssetPtr make_milk_carton(Random& random);  ///< with a gable
AssetPtr make_tea_box(Random& random);
AssetPtr make_sponge(Random& random);  ///< two layers, without texture
AssetPtr make_office_stapler(Random& random);

// These make toys, fruit and tools; the banana and the flashlight lie on their side.
AssetPtr make_beach_ball(Random& random);
AssetPtr make_toy_truck(Random& random);
AssetPtr make_banana(Random& random);
AssetPtr make_flashlight(Random& random);

}  // namespace houghstream::world
