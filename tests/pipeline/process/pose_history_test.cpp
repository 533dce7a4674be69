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
  PoseHistory history;
  EXPECT_TRUE(history.find_warm_start(detections({"LEFT", 1}, "mug")).poses.empty());
  history.add(poses({"LEFT", 1}, "mug"));
  history.add(poses({"RIGHT", 1}, "bowl"));
  EXPECT_EQ(history.find_warm_start(detections({"LEFT", 2}, "mug")).frame, (FrameId{"LEFT", 1}));
  EXPECT_EQ(history.find_warm_start(detections({"RIGHT", 2}, "bowl")).frame, (FrameId{"RIGHT", 1}));
  history.add(poses({"LEFT", 2}, "can"));
  EXPECT_EQ(history.find_warm_start(detections({"LEFT", 3}, "mug")).frame.utime, 2)
      << "one detector: the last ones, as they are";
}

TEST(PoseHistory, EachOfTwoDetectorsGoesOnFromItsOwnLastPoses) {
  PoseHistory history;
  for (std::int64_t utime = 1; utime <= 2; ++utime) {
    history.add(poses({"LEFT", utime}, "mug"));
    history.add(poses({"LEFT", utime}, "bowl"));
  }
  history.add(poses({"LEFT", 3}, "mug"));
  const ObjectPoses for_bowl = history.find_warm_start(detections({"LEFT", 3}, "bowl"));
  EXPECT_EQ(for_bowl.frame.utime, 2);
  EXPECT_EQ(for_bowl.poses.at(0).class_name, "bowl");
  EXPECT_EQ(history.find_warm_start(detections({"LEFT", 4}, "mug")).frame.utime, 3);
  EXPECT_TRUE(history.find_warm_start(detections({"LEFT", 4}, "can")).poses.empty());
}

TEST(PoseHistory, AClassThatTwoDetectorsFindInAFrameIsToldOnceForEachFurtherResult) {
  using Names = std::vector<std::string>;
  PoseHistory history;
  EXPECT_EQ(history.note_classes(detections({"LEFT", 1}, "mug"), 1), Names{});
  EXPECT_EQ(history.note_classes(detections({"LEFT", 1}, "bowl"), 1), Names{});
  EXPECT_EQ(history.note_classes(detections({"LEFT", 1}, "mug"), 1), Names{"mug"});
  EXPECT_EQ(history.note_classes(detections({"RIGHT", 1}, "mug"), 2), Names{}) << "another camera's frame";
  EXPECT_EQ(history.note_classes(detections({"LEFT", 1}, "mug"), 3), Names{}) << "another frame of the name";
  EXPECT_EQ(history.note_classes(detections({"LEFT", 1}, "mug"), 3), Names{"mug"});
}

TEST(PoseHistory, ResultsOfAFrameThatComesAgainCountAnew) {
  PoseHistory history;
  for (std::int64_t number = 1; number <= 2; ++number) {
    history.note_classes(detections({"LEFT", 1}, "mug"), number);
    history.add(poses({"LEFT", 1}, "mug"));
  }
  EXPECT_EQ(history.find_warm_start(detections({"LEFT", 2}, "bowl")).frame.utime, 1)
      << "one detector: the last ones, whatever they are of";
}

}  // namespace
}  // namespace houghstream
