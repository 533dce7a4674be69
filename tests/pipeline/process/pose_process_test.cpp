#include "pipeline/process/pose_process.hpp"

#include <houghstream/status_t.hpp>

#include "tests/pipeline/process_test.hpp"

namespace houghstream {
namespace {

using std::chrono::milliseconds;

Detections one_bowl(std::int64_t utime) {
  Detection bowl;
  bowl.class_id = 1;
  bowl.class_name = "bowl";
  bowl.box_px = {1, 2, 3, 4};
  Detections detections;
  detections.utime = utime;
  detections.source_channel = channel::kFrame;
  detections.detections = {bowl};
  return detections;
}

ObjectPoses at_one_metre(const RgbdFrame& frame, const Detections& detections) {
  EXPECT_EQ(frame.utime, detections.utime);
  ObjectPose pose;
  pose.class_name = detections.detections.at(0).class_name;
  pose.status = PoseStatus::kValid;
  pose.T_camera_object = Eigen::Isometry3d(Eigen::Translation3d(0, 0, 1));
  ObjectPoses poses;
  poses.utime = detections.utime;
  poses.poses = {pose};
  poses.stages = detections.stages;
  return poses;
}

void send_frame(ProcessOnMemq& test, std::int64_t utime) {
  test.bus.publish(channel::kFrame, to_message(make_test_frame(utime), WireFormat{}, utime));
}

void run_fake(LcmBus& bus) {
  run_pose_process(bus, PoseProcessOptions{}, at_one_metre);
}

TEST(PoseProcess, PublishesPosesAndTransforms) {
  ProcessOnMemq test({channel::kPoses, channel::kStatus, "BOWL_TO_CAMERA"});
  test.start(run_fake);
  send_frame(test, 10);
  test.bus.publish(channel::kDetections, to_message(one_bowl(10)));
  ASSERT_TRUE(test.wait_for("BOWL_TO_CAMERA", 1));
  const ObjectPoses poses = poses_from_message(test.at<object_poses_t>(channel::kPoses, 0));
  EXPECT_EQ(poses.utime, 10);
  EXPECT_EQ(poses.source_channel, channel::kFrame);
  ASSERT_EQ(poses.poses.size(), 1U);
  EXPECT_EQ(poses.stages.at(0).stage, "pose.decode");
  EXPECT_EQ(test.at<rigid_transform_t>("BOWL_TO_CAMERA", 0).trans[2], 1.0);
  EXPECT_LT(test.stop(), 1000.0);
}

TEST(PoseProcess, EmptyDetectionsGiveEmptyPosesWithoutDecoding) {
  ProcessOnMemq test({channel::kPoses, channel::kStatus});
  test.start(run_fake);
  images_t undecodable = to_message(make_test_frame(11), WireFormat{}, 0);
  undecodable.images[0].data.assign(10, 0);
  undecodable.images[0].size = 10;
  test.bus.publish(channel::kFrame, undecodable);
  Detections none = one_bowl(11);
  none.detections.clear();
  test.bus.publish(channel::kDetections, to_message(none));
  ASSERT_TRUE(test.wait_for(channel::kPoses, 1));
  EXPECT_EQ(test.at<object_poses_t>(channel::kPoses, 0).n_poses, 0);
  test.stop();
}

TEST(PoseProcess, DetectionsMayComeBeforeTheirFrame) {
  ProcessOnMemq test({channel::kPoses, channel::kStatus});
  test.start(run_fake);
  test.bus.publish(channel::kDetections, to_message(one_bowl(12)));
  std::this_thread::sleep_for(milliseconds(300));
  EXPECT_EQ(test.count(channel::kPoses), 0U);
  send_frame(test, 12);
  ASSERT_TRUE(test.wait_for(channel::kPoses, 1));
  EXPECT_EQ(test.at<object_poses_t>(channel::kPoses, 0).utime, 12);
  test.stop();
}

TEST(PoseProcess, DetectionsOfAFrameThatIsNotThereAreCountedAndDropped) {
  ProcessOnMemq test({channel::kPoses, channel::kStatus});
  test.start(run_fake);
  send_frame(test, 1);
  test.bus.publish(channel::kDetections, to_message(one_bowl(2)));
  const std::vector<std::uint8_t> noise(50, 0x5A);
  test.bus.publish(channel::kDetections, {noise.data(), noise.size()}, 0);
  test.bus.publish(channel::kFrame, {noise.data(), noise.size()}, 0);
  std::this_thread::sleep_for(milliseconds(300));
  test.stop();
  EXPECT_EQ(test.count(channel::kPoses), 0U);
  const auto status = test.last<status_t>(channel::kStatus);
  EXPECT_EQ(status.frames_received, 2);
  EXPECT_EQ(status.frames_refused, 2);
  EXPECT_EQ(status.frames_processed, 0);
  EXPECT_NE(status.last_error.find("frame 2"), std::string::npos) << status.last_error;
}

}  // namespace
}  // namespace houghstream
