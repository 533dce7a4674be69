#pragma once

#include "detector/training/pictures/composites.hpp"

namespace houghstream::training {

/// Puts something in front of the composite's object: a patch of the room, nearer than the object, of random shape
/// and place, that hides between a tenth and four fifths of it, with the infrared shadow that a structured-light
/// camera sees to its left. Nothing where no try hides as much as that.
void add_occluder(const RgbdFrame& room, double object_distance, Composite& composite, Random& random);

}  // namespace houghstream::training
