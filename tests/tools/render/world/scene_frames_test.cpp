#include "tools/render/world/scene_frames.hpp"

#include <gtest/gtest.h>

#include <array>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/parallel.hpp"
#include "tests/tools/render/world/scene_checks.hpp"

namespace houghstream::world {
namespace {

class SceneFrames : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    scene = make_named_scene("table_small_2");
    lit_world = light_world(scene.world);
  }
  static std::array<RenderedFrame, 3> render(int threads) {
    std::array<RenderedFrame, 3> frames;
    parallel_for(threads, 3, [&](int i) {
      frames[static_cast<std::size_t>(i)] = render_scene_frame(scene, lit_world, i * 100, 300);
    });
    return frames;
  }
  static inline Scene scene;
  static inline LitWorld lit_world;
};

TEST_F(SceneFrames, AreTheSameForAnyNumberOfThreads) {
  const auto serial = render(1);
  const auto parallel = render(2);
  for (std::size_t i = 0; i < serial.size(); ++i) {
    EXPECT_TRUE(identical(serial[i].frame.colour, parallel[i].frame.colour));
    EXPECT_TRUE(identical(serial[i].frame.depth, parallel[i].frame.depth));
  }
  EXPECT_FALSE(identical(serial[0].frame.colour, serial[1].frame.colour));
}

TEST_F(SceneFrames, TruthAgreesWithTheImage) {
  int seen = 0;
  for (const RenderedFrame& view : render(1)) {
    check_frame(view.frame, "rendered");
    ASSERT_EQ(view.objects.size(), view.visible_masks.size());
    for (std::size_t i = 0; i < view.objects.size(); ++i) {
      const GroundTruthObject& object = view.objects[i];
      ++seen;
      EXPECT_GT(object.visible_fraction, 0.0);
      EXPECT_LE(object.visible_fraction, 1.0);
      if (object.visible_fraction < 0.95) continue;
      const Eigen::Vector2d centre = view.frame.camera.project(object.T_camera_object.translation());
      EXPECT_TRUE(object.box_visible_px.contains({static_cast<int>(centre.x()), static_cast<int>(centre.y())}));
      // Depth measured on the object agrees with its pose.
      const cv::Scalar depth =
          cv::mean(view.frame.depth, view.visible_masks[i] & (view.frame.depth == view.frame.depth));
      EXPECT_NEAR(depth[0], object.T_camera_object.translation().z(), 0.12);
    }
  }
  EXPECT_GE(seen, 8);
}

TEST_F(SceneFrames, AnotherSensorSeesTheSameWorldInItsOwnWay) {
  const RenderedFrame usual = render_scene_frame(scene, lit_world, 100, 300);
  const RenderedFrame named = render_scene_frame(scene, lit_world, 100, 300, parse_sensor("structured_light"));
  EXPECT_TRUE(identical(usual.frame.colour, named.frame.colour) && identical(usual.frame.depth, named.frame.depth));
  const RenderedFrame other = render_scene_frame(scene, lit_world, 100, 300, parse_sensor("time_of_flight"));
  check_frame(other.frame, "rendered");
  EXPECT_FALSE(identical(usual.frame.colour, other.frame.colour));
  ASSERT_EQ(other.objects.size(), usual.objects.size());
  for (std::size_t i = 0; i < usual.objects.size(); ++i)
    EXPECT_TRUE(identical(usual.visible_masks[i], other.visible_masks[i])) << i;
  const cv::Mat both = (usual.frame.depth == usual.frame.depth) & (other.frame.depth == other.frame.depth);
  EXPECT_GT(cv::countNonZero(both), 640 * 480 / 2);
  EXPECT_GT(cv::countNonZero(other.frame.depth == other.frame.depth),
            cv::countNonZero(usual.frame.depth == usual.frame.depth))
      << "no infrared shadow";
  EXPECT_NEAR(cv::mean(usual.frame.depth, both)[0], cv::mean(other.frame.depth, both)[0], 0.02);
  EXPECT_THROW(parse_sensor("sonar"), InputError);
}

TEST_F(SceneFrames, DepthHasHolesButNotMany) {
  const cv::Mat depth = render(1)[0].frame.depth;
  const double valid = cv::countNonZero(depth == depth) / static_cast<double>(depth.total());
  EXPECT_GT(valid, 0.5);
  EXPECT_LT(valid, 0.99);
}

}  // namespace
}  // namespace houghstream::world
