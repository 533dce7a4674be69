#include <gtest/gtest.h>

#include "tools/render/world/objects/objects.hpp"
#include "tools/render/world/rooms/table_setter.hpp"

namespace houghstream::world {
namespace {

TEST(TableLayout, RectanglesTouchAsTheirSidesSay) {
  const Footprint square{{0, 0}, {0.1, 0.1}, 0.0};
  EXPECT_TRUE(footprints_touch(square, {{0.19, 0}, {0.1, 0.1}, 0.0}, 0.0));
  EXPECT_FALSE(footprints_touch(square, {{0.21, 0}, {0.1, 0.1}, 0.0}, 0.0));
  EXPECT_TRUE(footprints_touch(square, {{0.21, 0}, {0.1, 0.1}, 0.0}, 0.02));
  // Turned by 45 degrees a corner reaches 0.141.
  EXPECT_TRUE(footprints_touch(square, {{0.23, 0}, {0.1, 0.1}, M_PI / 4}, 0.0));
  EXPECT_FALSE(footprints_touch(square, {{0.25, 0}, {0.1, 0.1}, M_PI / 4}, 0.0));
}

TEST(TableLayout, ThingsStandApartUntilTheTableIsFull) {
  TableLayout layout({0.3, 0.2});
  Random random(1);
  const AssetPtr mug = make_taught_object(3).thing;
  const Eigen::AlignedBox2d everywhere(Eigen::Vector2d(-0.3, -0.2), Eigen::Vector2d(0.3, 0.2));
  int placed = 0;
  while (placed < 100 && layout.place(*mug, everywhere, M_PI, random)) ++placed;
  EXPECT_GT(placed, 4);
  EXPECT_LT(placed, 100);
  const auto& taken = layout.footprints();
  for (std::size_t i = 0; i < taken.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) EXPECT_FALSE(footprints_touch(taken[i], taken[j], 0.0));
  }
}

}  // namespace
}  // namespace houghstream::world
