#include "tools/view/drawing/overlay.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <opencv2/imgproc.hpp>

#include "pipeline/base/checks.hpp"

namespace houghstream::view {
namespace {

const Camera kCamera{320, 240, 262.5, 262.5, 159.5, 119.5};
const cv::Vec3b kGrey(90, 90, 90);

RgbdFrame grey_frame() {
  RgbdFrame frame;
  frame.id = {"TEST", 7};
  frame.colour = cv::Mat(240, 320, CV_8UC3, cv::Scalar(kGrey[0], kGrey[1], kGrey[2]));
  frame.depth = cv::Mat(240, 320, CV_32FC1, cv::Scalar(std::numeric_limits<float>::quiet_NaN()));
  frame.camera = kCamera;
  return frame;
}

Detections one_detection() {
  Detection detection;
  detection.class_id = 1;
  detection.class_name = "box";
  detection.score = 0.5F;
  detection.box_px = {100, 80, 120, 90};
  return Detections{{"TEST", 7}, {detection}, {}};
}

ObjectPoses one_pose(const Eigen::Isometry3d& T_camera_object) {
  ObjectPose pose;
  pose.class_id = 1;
  pose.class_name = "box";
  pose.detection_index = 0;
  pose.status = PoseStatus::kValid;
  pose.T_camera_object = T_camera_object;
  return ObjectPoses{{"TEST", 7}, {pose}, {}};
}

// Returns a square plate of 0.2 m, facing the camera.
Mesh plate() {
  Mesh mesh;
  mesh.vertices = {{-0.1F, -0.1F, 0}, {0.1F, -0.1F, 0}, {0.1F, 0.1F, 0}, {-0.1F, 0.1F, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {2, 1, 0}, {3, 2, 0}};
  return mesh;
}

Eigen::Isometry3d one_metre_ahead() {
  Eigen::Isometry3d T_camera_object = Eigen::Isometry3d::Identity();
  T_camera_object.translation().z() = 1.0;
  return T_camera_object;
}

// Returns whether there are pixels of about this colour within `radius` of (x, y).
bool shows(const cv::Mat& image, const cv::Scalar& colour, int x, int y, int radius) {
  const cv::Mat region = image(cv::Rect(x - radius, y - radius, 2 * radius + 1, 2 * radius + 1));
  cv::Mat close;
  cv::inRange(region, colour - cv::Scalar::all(40), colour + cv::Scalar::all(40), close);
  return cv::countNonZero(close) > 0;
}

TEST(Overlay, NothingFoundLeavesTheImageAsItIs) {
  const RgbdFrame frame = grey_frame();
  const cv::Mat image = draw_overlay(frame, Detections{{"TEST", 7}, {}, {}}, std::nullopt, {});
  EXPECT_EQ(cv::norm(image, frame.colour, cv::NORM_INF), 0.0);
}

TEST(Overlay, BoxIsDrawnInTheColourOfItsClassAndTheFrameStaysUntouched) {
  const RgbdFrame frame = grey_frame();
  const cv::Mat image = draw_overlay(frame, one_detection(), std::nullopt, {});
  EXPECT_TRUE(shows(image, class_colour(1), 100, 125, 2));
  EXPECT_TRUE(shows(image, class_colour(1), 160, 169, 2));
  EXPECT_EQ(image.at<cv::Vec3b>(130, 150), kGrey);
  EXPECT_EQ(frame.colour.at<cv::Vec3b>(125, 100), kGrey);
}

TEST(Overlay, OutlineRunsAlongTheProjectedModelAndAxesStartAtItsOrigin) {
  Detections detections = one_detection();
  const cv::Mat image = draw_overlay(grey_frame(), detections, one_pose(one_metre_ahead()), {{"box", plate()}});
  // Half the plate is 0.1 m * 262.5 px at 1 m = 26 px from the principal point.
  EXPECT_TRUE(shows(image, class_colour(1), 160 - 26, 105, 2));
  EXPECT_TRUE(shows(image, class_colour(1), 150, 120 - 26, 2));
  EXPECT_TRUE(shows(image, {60, 60, 255}, 160 + 15, 120, 2));  // x to the right, red
  EXPECT_TRUE(shows(image, {60, 220, 60}, 160, 120 + 15, 2));  // y down, green
}

TEST(Overlay, ModelBehindOrBesideTheCameraIsNotDrawn) {
  Eigen::Isometry3d behind = one_metre_ahead();
  behind.translation().z() = -1.0;
  Eigen::Isometry3d beside = one_metre_ahead();
  beside.translation().x() = 50.0;
  for (const Eigen::Isometry3d& pose : {behind, beside}) {
    const cv::Mat image = draw_overlay(grey_frame(), one_detection(), one_pose(pose), {{"box", plate()}});
    const cv::Mat without = draw_overlay(grey_frame(), one_detection(), std::nullopt, {});
    EXPECT_EQ(cv::norm(image, without, cv::NORM_INF), 0.0);
  }
}

TEST(Overlay, FollowedPosesHaveTheBoxesOfTheirModels) {
  ObjectPoses followed = one_pose(one_metre_ahead());
  followed.poses[0].detection_index = -1;
  followed.poses[0].detection_score = 0.75F;
  followed.poses.insert(followed.poses.begin(), 2, followed.poses[0]);
  followed.poses[0].class_name = "unknown";
  followed.poses[1].T_camera_object.reset();
  followed.poses[1].status = PoseStatus::kOccluded;
  const BoxedPoses all = boxed(followed, {{"box", plate()}}, kCamera);
  ASSERT_EQ(all.poses.poses.size(), 2U);
  ASSERT_EQ(all.detections.detections.size(), 2U);
  EXPECT_EQ(all.poses.poses[1].detection_index, 1);
  EXPECT_NEAR(all.detections.detections[0].box_px.width, 0.1 / 0.95 * kCamera.fx, 6.0) << "nobody knows its model";
  const Detection& detection = all.detections.detections[1];
  EXPECT_EQ(detection.score, 0.75F);
  EXPECT_NEAR(detection.box_px.width, 0.2 * kCamera.fx, 6.0);
  EXPECT_NEAR(detection.box_px.x + 0.5 * detection.box_px.width, kCamera.cx, 3.0);
  EXPECT_NO_THROW(draw_overlay(grey_frame(), all.detections, all.poses, {{"box", plate()}}));
}

TEST(Overlay, AnObjectHasOneLabelThatOfItsTrack) {
  const Detections detections = one_detection();
  Label track{"#4 box 0.90", cv::Rect(150, 120, 9, 9), class_colour(1), 1};
  const cv::Mat own = draw_overlay(grey_frame(), detections, std::nullopt, {});
  const cv::Mat joined = draw_overlay(grey_frame(), detections, std::nullopt, {}, {{track}, {}});
  const cv::Rect above(100, 55, 120, 24);
  EXPECT_GT(cv::norm(own(above), joined(above)), 0.0) << "the detection has the text of its track";
  const cv::Rect inside(106, 90, 108, 74);
  EXPECT_EQ(cv::norm(own(inside), joined(inside)), 0.0) << "the track has no label of its own";
  for (const Label& other : {Label{track.text, track.thing, track.background, 2},
                             Label{track.text, cv::Rect(20, 200, 9, 9), track.background, 1}}) {
    const cv::Mat both = draw_overlay(grey_frame(), detections, std::nullopt, {}, {{other}, {}});
    const cv::Rect label(101, 64, 60, 14);
    EXPECT_EQ(cv::norm(own(label), both(label)), 0.0) << "another object keeps its label";
    EXPECT_GT(cv::norm(own, both), 0.0);
  }
}

TEST(Overlay, MissingPoseChangesTheLabel) {
  ObjectPoses poses = one_pose(one_metre_ahead());
  poses.poses[0].T_camera_object.reset();
  poses.poses[0].status = PoseStatus::kTooFewPoints;
  const cv::Mat without = draw_overlay(grey_frame(), one_detection(), std::nullopt, {});
  const cv::Mat with_reason = draw_overlay(grey_frame(), one_detection(), poses, {});
  EXPECT_GT(cv::norm(without, with_reason, cv::NORM_INF), 0.0);
}

TEST(Overlay, ResultsOfAnotherFrameAreRefused) {
  Detections detections = one_detection();
  detections.frame.utime = 8;
  EXPECT_THROW(draw_overlay(grey_frame(), detections, std::nullopt, {}), InputError);
  ObjectPoses poses = one_pose(one_metre_ahead());
  poses.frame.utime = 8;
  EXPECT_THROW(draw_overlay(grey_frame(), one_detection(), poses, {}), InputError);
  poses.frame.utime = 7;
  poses.poses[0].detection_index = 1;
  EXPECT_THROW(draw_overlay(grey_frame(), one_detection(), poses, {}), InputError);
}

TEST(Overlay, NeighbouringClassesDifferAndNegativeIdsHaveAColour) {
  for (int id = -3; id < 12; ++id) EXPECT_NE(class_colour(id), class_colour(id + 1));
}

}  // namespace
}  // namespace houghstream::view
