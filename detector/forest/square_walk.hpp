#pragma once

#include <cstdint>
#include <vector>

#include "detector/forest/patch_square.hpp"
#include "detector/forest/square_forest.hpp"

namespace houghstream {

/// Leaf of each patch of a square in each of the first trees, tree by tree in the order of its run, from what
/// copy_planes made of the square. Node by node: a test is made of whole rows of patches at once; only where few are
/// left at a node do they walk on one by one. The leaves are those of find_leaf.
void walk_square(const SquareForest& forest, int trees, const PatchSquare& square,
                 const std::vector<std::uint8_t>& planes, std::int32_t* leaves);

}  // namespace houghstream
