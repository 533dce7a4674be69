#include "tools/render/world/takes/hand_path.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace houghstream::world {
namespace {

TEST(UnevenProgress, GoesFromStartToEndNeverBackAndUnevenly) {
  const UnevenProgress progress(16.0, 3);
  EXPECT_EQ(progress.at(-1.0), 0.0);
  EXPECT_EQ(progress.at(0.0), 0.0);
  EXPECT_EQ(progress.at(16.0), 1.0);
  EXPECT_EQ(progress.at(20.0), 1.0);
  double slowest = 1.0;
  double fastest = 0.0;
  for (int i = 10; i < 150; ++i) {
    const double step = progress.at(0.1 * (i + 1)) - progress.at(0.1 * i);
    slowest = std::min(slowest, step);
    fastest = std::max(fastest, step);
  }
  EXPECT_GT(slowest, 0.0);
  EXPECT_GT(fastest, 2.0 * slowest);
}

TEST(HandPath, GoesOnceRoundLooksAtTheTargetAndComesBack) {
  HandPathSettings settings;
  for (const std::uint64_t seed : {2U, 4U, 6U}) {
    const HandPath path(settings, seed);
    double rotated = 0.0;
    Eigen::Vector3d before = path.T_camera_world(0.0).inverse().translation() - settings.target_world;
    const Eigen::Vector3d first = before;
    for (int i = 1; i <= 160; ++i) {
      const Eigen::Isometry3d T_camera_world = path.T_camera_world(0.1 * i);
      const Eigen::Vector3d now = T_camera_world.inverse().translation() - settings.target_world;
      rotated += std::atan2(before.x() * now.y() - before.y() * now.x(), before.head<2>().dot(now.head<2>()));
      before = now;
      EXPECT_NEAR(now.norm(), settings.distance_m, 0.2 * settings.distance_m);
      EXPECT_GT(now.z(), 0.3 * settings.distance_m);
      const Eigen::Vector3d seen = T_camera_world * settings.target_world;
      EXPECT_LT(std::hypot(seen.x(), seen.y()), 0.15 * seen.z()) << "near the picture's middle";
    }
    EXPECT_NEAR(std::abs(rotated), settings.angle_rad, 0.1);
    EXPECT_GT(first.normalized().dot(before.normalized()), 0.85) << "the end meets the start";
  }
}

}  // namespace
}  // namespace houghstream::world
