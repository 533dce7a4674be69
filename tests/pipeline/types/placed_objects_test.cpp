#include "pipeline/types/placed_objects.hpp"

#include <gtest/gtest.h>

namespace houghstream {
namespace {

TEST(PlacedObjects, AnObjectIsFoundByItsNumber) {
  ObjectPlacements placed;
  EXPECT_EQ(placed.find(1), nullptr);
  for (const std::int64_t number : {3, 5}) placed.objects.emplace_back().track_id = number;
  EXPECT_EQ(placed.find(5), &placed.objects[1]);
  EXPECT_EQ(placed.find(4), nullptr);
}

}  // namespace
}  // namespace houghstream
