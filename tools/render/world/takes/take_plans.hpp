#pragma once

#include <string>
#include <vector>

#include "tools/render/world/takes/take_stage.hpp"

namespace houghstream::world {

/// A take among those that `hs-render takes` makes.
struct NumberedTake {
  int scene = 1;  ///< of test/00000N/; an object's takes keep their numbers, whichever others are asked for
  int take = 1;   ///< 1: upright, 2: laid on its side or turned over
  std::string object;
  TakePlan plan;
};

/// Both takes of the twelve objects of the scenes objects_20_b, _d and _f, from plain (bowl, tumbler, teapot) to
/// printed (cartons, cans): eight before a camera that is carried round them, two on a turntable, two turned by hand.
/// Every object has a room of its own, which both takes share. `world` names a set of rooms and movements.
std::vector<NumberedTake> twelve_objects_takes(DatasetSplit use, int world, double seconds);

}  // namespace houghstream::world
