#include "tools/render/world/optics/light.hpp"

#include <gtest/gtest.h>

namespace houghstream::world {
namespace {

World lit(TimeOfDay time, std::uint64_t seed) {
  World world;
  set_lighting(world, time, seed);
  return world;
}

TEST(Light, EveningsAreDarkerWarmerAndNoisier) {
  for (std::uint64_t seed = 1; seed < 20; ++seed) {
    const World day = lit(TimeOfDay::kDay, seed);
    const World evening = lit(TimeOfDay::kEvening, seed);
    EXPECT_LT(evening.photo.mean_level, day.photo.mean_level);
    EXPECT_GT(evening.photo.shot_noise, day.photo.shot_noise);
    EXPECT_LT(evening.ambient_bgr.sum(), day.ambient_bgr.sum());
    ASSERT_EQ(evening.lights.size(), day.lights.size());
    for (std::size_t i = 0; i < day.lights.size(); ++i) {
      const Eigen::Vector3f& before = day.lights[i].colour_bgr;
      const Eigen::Vector3f& after = evening.lights[i].colour_bgr;
      EXPECT_LT(after[0] / after[2], before[0] / before[2]);  // less blue against red
    }
  }
}

TEST(Light, FollowsTheSeed) {
  EXPECT_EQ(lit(TimeOfDay::kDay, 3).lights[0].position_world, lit(TimeOfDay::kDay, 3).lights[0].position_world);
  EXPECT_NE(lit(TimeOfDay::kDay, 3).lights[0].position_world, lit(TimeOfDay::kDay, 4).lights[0].position_world);
}

}  // namespace
}  // namespace houghstream::world
