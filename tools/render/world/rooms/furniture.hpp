#pragma once

#include "pipeline/base/random.hpp"
#include "tools/render/world/objects/world.hpp"

// Furniture, as things whose origin is on the floor (or wall) in the middle, front to -y. Lengths in metres.

namespace houghstream::world {

ThingPtr make_table(const Eigen::Vector2d& half, double height, const cv::Mat& top, Random& random);  ///< top at z = 0
ThingPtr make_chair(Random& random);
ThingPtr make_bookshelf(Random& random);
ThingPtr make_cabinet(const Eigen::Vector3d& size, Random& random);  ///< with doors and handles; origin at its centre
ThingPtr make_picture(Random& random);                               ///< a poster to hang; origin at its centre
ThingPtr make_window(Random& random);                                ///< bright, with a frame; origin at its centre
ThingPtr make_bin(Random& random);

}  // namespace houghstream::world
