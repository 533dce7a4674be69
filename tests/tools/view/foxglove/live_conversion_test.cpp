#include "tools/view/foxglove/live_conversion.hpp"

#include <gtest/gtest.h>

#include "pipeline/messages/messages.hpp"
#include "pipeline/types/frame_results.hpp"
#include "tests/pipeline/test_frame.hpp"

namespace houghstream::view {
namespace {

Detections detections_at(std::int64_t utime, const std::string& name = "mug", const std::string& channel = "CAM") {
  Detections found;
  found.frame = {channel, utime};
  Detection detection;
  detection.class_id = 1;
  detection.class_name = name;
  detection.score = 0.9F;
  found.detections = {detection};
  return found;
}

ObjectPoses poses_at(std::int64_t utime, const std::string& name = "mug") {
  ObjectPoses poses;
  poses.frame = {"CAM", utime};
  ObjectPose pose;
  pose.class_id = 1;
  pose.class_name = name;
  pose.detection_index = 0;
  pose.status = PoseStatus::kValid;
  pose.T_camera_object = Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, 1.0));
  poses.poses = {pose};
  return poses;
}

bool has_topic(const LiveConversion::Messages& messages, const std::string& topic) {
  for (const foxglove::FoxgloveMessage& message : messages) {
    if (message.topic == topic) return true;
  }
  return false;
}

TEST(LiveConversion, ShowsAFrameAtOnceAndItsObjectsWithTheirPoses) {
  LiveConversion conversion(std::nullopt);
  EXPECT_TRUE(has_topic(conversion.add_frame(to_message(make_test_frame(5), WireFormat(), 0), "CAM"), "/CAM/colour"));
  EXPECT_TRUE(conversion.add_detections(detections_at(5)).empty()) << "whether they count, the poses tell";
  const LiveConversion::Messages messages = conversion.add_poses(poses_at(5));
  EXPECT_TRUE(has_topic(messages, "/CAM/annotations"));
  EXPECT_TRUE(has_topic(messages, "/transforms"));
  EXPECT_TRUE(has_topic(messages, "/CAM/objects/mug"));
}

TEST(LiveConversion, WithoutHsPoseShowsDetectionsAlone) {
  LiveConversion conversion(std::nullopt);
  bool shown = false;
  int needed = 0;
  for (; needed < 100 && !shown; ++needed)
    shown = has_topic(conversion.add_detections(detections_at(needed)), "/CAM/annotations");
  EXPECT_TRUE(shown);
  EXPECT_GT(needed, 10) << "hs-pose may be late";
  EXPECT_TRUE(has_topic(conversion.add_poses(poses_at(needed - 1)), "/CAM/annotations")) << "it was started";
  EXPECT_TRUE(conversion.add_detections(detections_at(needed)).empty()) << "from now on it is waited for";
}

TEST(LiveConversion, WaitsForAllDetectors) {
  LiveConversion conversion(std::nullopt);
  for (std::int64_t utime : {1, 2}) {
    conversion.add_frame(to_message(make_test_frame(utime), WireFormat(), 0), "CAM");
    conversion.add_detections(detections_at(utime, "mug"));
    conversion.add_detections(detections_at(utime, "can"));
    conversion.add_poses(poses_at(utime, "mug"));
    conversion.add_poses(poses_at(utime, "can"));
  }
  conversion.add_frame(to_message(make_test_frame(3), WireFormat(), 0), "CAM");
  conversion.add_detections(detections_at(3, "mug"));
  EXPECT_TRUE(conversion.add_poses(poses_at(3, "mug")).empty()) << "the other detector has not answered";
  conversion.add_detections(detections_at(3, "can"));
  EXPECT_TRUE(has_topic(conversion.add_poses(poses_at(3, "can")), "/CAM/annotations"));
}

TEST(LiveConversion, FollowedObjectsAreShownBeforeTheirDetections) {
  LiveConversion conversion(std::nullopt);
  ObjectPoses followed = poses_at(5);
  followed.poses[0].detection_index = -1;
  followed.stages = {{kFollowingStage, 100}};
  EXPECT_TRUE(has_topic(conversion.add_poses(followed), "/transforms"));
}

TEST(LiveConversion, DoesNotGoBackButForASourceThatStartsAgain) {
  LiveConversion conversion(std::nullopt);
  const auto show = [&](std::int64_t utime) {
    conversion.add_detections(detections_at(utime));
    return !conversion.add_poses(poses_at(utime)).empty();
  };
  EXPECT_TRUE(show(10'000'000));
  EXPECT_FALSE(show(9'967'000));
  EXPECT_TRUE(show(10'033'000));
  EXPECT_TRUE(show(1'000'000)) << "a log that is played again";
  EXPECT_TRUE(show(1'033'000));
}

TEST(LiveConversion, ASenderOfRubbishMakesUpNoCamerasWithoutEnd) {
  LiveConversion conversion(std::nullopt);
  for (std::size_t i = 0; i < LiveConversion::kMaxCameras; ++i)
    conversion.add_detections(detections_at(1, "mug", "CAMERA_" + std::to_string(i)));
  EXPECT_TRUE(conversion.add_frame(to_message(make_test_frame(5), WireFormat(), 0), "CAM").empty());
  EXPECT_FALSE(conversion.add_frame(to_message(make_test_frame(5), WireFormat(), 0), "CAMERA_3").empty());
}

}  // namespace
}  // namespace houghstream::view
