#include "pipeline/process/pose_history.hpp"

#include <gtest/gtest.h>

namespace houghstream {
namespace {

Detections detections(const FrameId& frame, const std::string& object) {
  Detection found;
  found.class_name = object;
  return {frame, {found}, {}};
}

ObjectPoses poses(const FrameId& frame, const std::string& object) {
  ObjectPose pose;
  pose.class_name = object;
  return {frame, {pose}, {}};
}

TEST(PoseHistory, TheLastPosesOfTheCameraWhateverTheOtherOneSaw) {
  PoseHistory memory;
  EXPECT_TRUE(memory.before(detections({"LEFT", 1}, "mug")).poses.empty());
  memory.keep(poses({"LEFT", 1}, "mug"));
  memory.keep(poses({"RIGHT", 1}, "bowl"));
  EXPECT_EQ(memory.before(detections({"LEFT", 2}, "mug")).frame, (FrameId{"LEFT", 1}));
  EXPECT_EQ(memory.before(detections({"RIGHT", 2}, "bowl")).frame, (FrameId{"RIGHT", 1}));
  memory.keep(poses({"LEFT", 2}, "can"));
  EXPECT_EQ(memory.before(detections({"LEFT", 3}, "mug")).frame.utime, 2) << "one detector: the last ones, as they are";
}

TEST(PoseHistory, EachOfTwoDetectorsGoesOnFromItsOwnLastPoses) {
  PoseHistory memory;
  for (std::int64_t utime = 1; utime <= 2; ++utime) {
    memory.keep(poses({"LEFT", utime}, "mug"));
    memory.keep(poses({"LEFT", utime}, "bowl"));
  }
  memory.keep(poses({"LEFT", 3}, "mug"));
  const ObjectPoses for_bowl = memory.before(detections({"LEFT", 3}, "bowl"));
  EXPECT_EQ(for_bowl.frame.utime, 2);
  EXPECT_EQ(for_bowl.poses.at(0).class_name, "bowl");
  EXPECT_EQ(memory.before(detections({"LEFT", 4}, "mug")).frame.utime, 3);
  EXPECT_TRUE(memory.before(detections({"LEFT", 4}, "can")).poses.empty());
}

}  // namespace
}  // namespace houghstream
