#include "tools/studies/recorded/pose_sheets.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "tests/test_files.hpp"

namespace houghstream {
namespace {

/// Returns a square of 0.2 m, 1 m in front of the camera: pixels 26 to 37 each way of plain_frame().
view::ClassModels square(const cv::Vec3b& colour) {
  Mesh mesh;
  mesh.vertices = {{-0.1F, -0.1F, 0.0F}, {0.1F, -0.1F, 0.0F}, {0.1F, 0.1F, 0.0F}, {-0.1F, 0.1F, 0.0F}};
  mesh.colours.assign(4, colour);
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}};
  return {{"plate", mesh}};
}

ObjectPoses in_front() {
  ObjectPoses poses;
  poses.poses.resize(1);
  ObjectPose& pose = poses.poses[0];
  pose.class_id = 1;
  pose.class_name = "plate";
  pose.status = PoseStatus::kValid;
  pose.T_camera_object = Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, 1.0));
  return poses;
}

TEST(PoseSheets, AModelIsPaintedInItsColoursOverTheDarkenedImage) {
  const RgbdFrame frame = plain_frame();
  const cv::Mat image = paint_models(frame, in_front(), square({200, 100, 50}));
  EXPECT_EQ(image.at<cv::Vec3b>(24, 32), cv::Vec3b(200, 100, 50));
  EXPECT_EQ(image.at<cv::Vec3b>(2, 2), cv::Vec3b(4, 8, 12)) << "two fifths of the picture's 10, 20, 30";
}

TEST(PoseSheets, WithoutPoseOrModelNothingIsPainted) {
  const RgbdFrame frame = plain_frame();
  ObjectPoses none = in_front();
  none.poses[0].T_camera_object.reset();
  EXPECT_EQ(paint_models(frame, none, square({1, 2, 3})).at<cv::Vec3b>(24, 32), cv::Vec3b(4, 8, 12));
  EXPECT_EQ(paint_models(frame, in_front(), {}).at<cv::Vec3b>(24, 32), cv::Vec3b(4, 8, 12));
}

TEST(PoseSheets, TheOutlineLeavesWhatLiesUnderTheModel) {
  const RgbdFrame frame = plain_frame();
  cv::Mat image = frame.colour.clone();
  draw_outline(image, square({1, 2, 3}).at("plate"), *in_front().poses[0].T_camera_object, frame.camera,
               cv::Scalar(0, 0, 255));
  cv::Mat drawn;
  cv::inRange(image, cv::Scalar(0, 0, 255), cv::Scalar(0, 0, 255), drawn);
  EXPECT_EQ(image.at<cv::Vec3b>(24, 32), frame.colour.at<cv::Vec3b>(24, 32));
  const cv::Rect box = cv::boundingRect(drawn);
  EXPECT_NEAR(box.width, 12, 1);
  EXPECT_NEAR(box.height, 12, 1);
  EXPECT_EQ(cv::countNonZero(drawn), 2 * (box.width + box.height) - 4) << "one pixel wide";
}

TEST(PoseSheets, EachPoseHasALineBelowTheTitle) {
  const RgbdFrame frame = plain_frame();
  const cv::Mat titled = draw_poses(frame, {}, {}, {}, "frame");
  EXPECT_GT(cv::norm(titled, frame.colour, cv::NORM_L1), 0.0);
  EXPECT_GT(cv::norm(draw_poses(frame, in_front(), {}, {}, "frame"), titled, cv::NORM_L1), 0.0);
}

TEST(PoseSheets, AWithheldPoseIsAWhiteOutlineWithoutALine) {
  const RgbdFrame frame = plain_frame();
  const cv::Mat titled = draw_poses(frame, {}, {}, square({1, 2, 3}), "frame");
  cv::Mat changed;
  cv::absdiff(draw_poses(frame, {}, in_front(), square({1, 2, 3}), "frame"), titled, changed);
  cv::cvtColor(changed, changed, cv::COLOR_BGR2GRAY);
  EXPECT_NEAR(cv::boundingRect(changed).width, 12, 1);
  EXPECT_EQ(draw_poses(frame, {}, in_front(), square({1, 2, 3}), "frame").at<cv::Vec3b>(24, 32),
            frame.colour.at<cv::Vec3b>(24, 32));
}

TEST(PoseSheets, FourTilesToASheet) {
  const std::vector<cv::Mat> tiles(5, cv::Mat(10, 20, CV_8UC3, cv::Scalar(1, 2, 3)));
  EXPECT_EQ(make_sheets(tiles).size(), 2U);
  EXPECT_EQ(make_sheets({tiles[0]}).size(), 1U);
  EXPECT_TRUE(make_sheets({}).empty());
}

}  // namespace
}  // namespace houghstream
