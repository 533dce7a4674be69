#include "pose/reconstruction/object_choice.hpp"

#include <gtest/gtest.h>

#include "tests/pose/reconstruction/shown_scene.hpp"

namespace houghstream::reconstruction {
namespace {

using test_scene::photograph;
using test_scene::ShownScene;
using test_scene::table_with;

RgbdFrame frame_of(const ShownScene& scene) {
  return photograph(table_with(scene), test_scene::camera_at(0.4, 0.6, 0.7), scene.camera, 1);
}

TEST(ObjectChoice, FindsWhatStandsInTheMiddle) {
  const Choice choice = choose_object(frame_of({}), {});
  ASSERT_TRUE(choice.object) << choice.reason;
  const Eigen::Isometry3d T = test_scene::camera_at(0.4, 0.6, 0.7);
  EXPECT_NEAR(choice.object->height_m, 0.16, 0.005);
  EXPECT_LT(std::abs(choice.object->plane.height(T.translation())), 0.002);  // the table's middle
  EXPECT_LT((choice.object->T_camera_stand.translation() - T.translation()).norm(), 0.03);
}

TEST(ObjectChoice, TakesNoTurntableForTheObject) {
  ShownScene scene;
  scene.box = {0.06, 0.06, 0.10};
  scene.disc = {0.26, 0.26, 0.016};
  const Choice choice = choose_object(frame_of(scene), {});
  ASSERT_TRUE(choice.object) << choice.reason;
  EXPECT_NEAR(choice.object->height_m, 0.10, 0.005);
  EXPECT_LT(choice.object->radius_m, 0.065);
}

TEST(ObjectChoice, SaysWhyThereIsNone) {
  ShownScene empty;
  empty.box.setZero();
  EXPECT_NE(choose_object(frame_of(empty), {}).reason.find("nothing with depth stands near the picture's middle"),
            std::string::npos);
  RgbdFrame blind = frame_of({});
  blind.depth.setTo(std::numeric_limits<float>::quiet_NaN());
  EXPECT_NE(choose_object(blind, {}).reason.find("no table"), std::string::npos);
  ChoiceSettings outside;
  outside.box_px = cv::Rect(300, 200, 100, 100);
  EXPECT_NE(choose_object(frame_of({}), outside).reason.find("320x240"), std::string::npos);
  ShownScene huge;
  huge.box = {0.5, 0.5, 0.3};
  EXPECT_FALSE(choose_object(frame_of(huge), {}).object);
}

}  // namespace
}  // namespace houghstream::reconstruction
