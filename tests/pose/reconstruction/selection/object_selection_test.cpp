#include "pose/reconstruction/selection/object_selection.hpp"

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
  const ObjectSelection choice = select_object(frame_of({}), {});
  ASSERT_TRUE(choice.object) << choice.reason;
  const Eigen::Isometry3d T = test_scene::camera_at(0.4, 0.6, 0.7);
  EXPECT_NEAR(choice.object->height_m, 0.16, 0.005);
  EXPECT_LT(std::abs(choice.object->plane.signedDistance(T.translation())), 0.002);  // the table's middle
  EXPECT_LT((choice.object->T_camera_stand.translation() - T.translation()).norm(), 0.03);
}

TEST(ObjectChoice, TakesWhatStandsNearestToAPlaceThatIsPointedAt) {
  const Eigen::Vector3f beside(-0.05F, 0.24F, 0.0F);
  const Eigen::Isometry3d T = test_scene::camera_at(0.4, 0.6, 0.7);
  Mesh mesh = table_with({});
  const std::size_t first = mesh.vertices.size();
  test_scene::add_box({0.05, 0.05, 0.06}, 0.0, mesh);
  for (std::size_t i = first; i < mesh.vertices.size(); ++i) mesh.vertices[i] += beside;
  const RgbdFrame frame = photograph(mesh, T, ShownScene().camera, 1);
  const ObjectSelection in_the_middle = select_object(frame, {});
  ASSERT_TRUE(in_the_middle.object) << in_the_middle.reason;
  EXPECT_NEAR(in_the_middle.object->height_m, 0.16, 0.005);
  SelectionSettings pointing;
  const Eigen::Vector2d px = frame.camera.project(T * Eigen::Vector3d(-0.05, 0.24, 0.05));
  pointing.at_px = cv::Point(cvRound(px.x()), cvRound(px.y()));
  const ObjectSelection there = select_object(frame, pointing);
  ASSERT_TRUE(there.object) << there.reason;
  EXPECT_NEAR(there.object->height_m, 0.06, 0.005);
  pointing.at_px = cv::Point(5, 5);
  EXPECT_EQ(select_object(frame, pointing).reason,
            "nothing with depth stands near 5,5, expected an object on the table there");
  pointing.at_px = cv::Point(400, 5);
  EXPECT_EQ(select_object(frame, pointing).reason, "400,5 lies not within the picture, which has 320x240 pixels");
}

TEST(ObjectChoice, TakesNoTurntableForTheObject) {
  ShownScene scene;
  scene.box = {0.06, 0.06, 0.10};
  scene.disc = {0.26, 0.26, 0.016};
  const ObjectSelection choice = select_object(frame_of(scene), {});
  ASSERT_TRUE(choice.object) << choice.reason;
  EXPECT_NEAR(choice.object->height_m, 0.10, 0.005);
  EXPECT_LT(choice.object->radius_m, 0.065);
}

TEST(ObjectChoice, SaysWhyThereIsNone) {
  ShownScene empty;
  empty.box.setZero();
  EXPECT_NE(select_object(frame_of(empty), {}).reason.find("nothing with depth stands near the picture's middle"),
            std::string::npos);
  RgbdFrame blind = frame_of({});
  blind.depth.setTo(std::numeric_limits<float>::quiet_NaN());
  EXPECT_NE(select_object(blind, {}).reason.find("no table"), std::string::npos);
  SelectionSettings outside;
  outside.box_px = cv::Rect(300, 200, 100, 100);
  EXPECT_NE(select_object(frame_of({}), outside).reason.find("320x240"), std::string::npos);
  ShownScene huge;
  huge.box = {0.5, 0.5, 0.3};
  EXPECT_FALSE(select_object(frame_of(huge), {}).object);
}

}  // namespace
}  // namespace houghstream::reconstruction
