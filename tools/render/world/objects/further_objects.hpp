#pragma once

#include "pipeline/base/random.hpp"
#include "tools/render/world/objects/thing.hpp"

// The sixteen further classes (ids 101 to 116), by family. Sizes and colours are fixed, the generator only draws
// prints. Each is finished: origin at the centre of its bounding box, z up, front to -y.

namespace houghstream::world {

// Tableware.
ThingPtr make_plate(Random& random);    ///< plain with a coloured rim
ThingPtr make_teapot(Random& random);   ///< one colour
ThingPtr make_pitcher(Random& random);  ///< enamel
ThingPtr make_tumbler(Random& random);  ///< one colour with bands

// Containers.
ThingPtr make_water_bottle(Random& random);
ThingPtr make_shampoo_bottle(Random& random);  ///< oval
ThingPtr make_jam_jar(Random& random);
ThingPtr make_food_tin(Random& random);

// Packs and desk things.
ThingPtr make_milk_carton(Random& random);  ///< with a gable
ThingPtr make_tea_box(Random& random);
ThingPtr make_sponge(Random& random);  ///< two layers, no print
ThingPtr make_office_stapler(Random& random);

// Toys, fruit, tools; the banana and the flashlight lie on their side.
ThingPtr make_beach_ball(Random& random);
ThingPtr make_toy_truck(Random& random);
ThingPtr make_banana(Random& random);
ThingPtr make_flashlight(Random& random);

}  // namespace houghstream::world
