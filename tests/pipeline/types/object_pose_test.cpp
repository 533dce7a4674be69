#include "pipeline/types/object_pose.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace houghstream {
namespace {

TEST(PoseStatus, EachHasWordsOfItsOwn) {
  std::set<std::string> words;
  for (int status = 0; status <= static_cast<int>(PoseStatus::kRefuted); ++status) {
    words.insert(to_string(static_cast<PoseStatus>(status)));
  }
  EXPECT_EQ(words.size(), 12U);
  EXPECT_EQ(words.count("unknown"), 0U);
  EXPECT_STREQ(to_string(static_cast<PoseStatus>(99)), "unknown");
}

TEST(IsReported, ACandidateIsConfirmedByAValidPoseAlone) {
  Detection detection;
  ObjectPose pose;
  pose.status = PoseStatus::kRejectedByDepth;
  EXPECT_TRUE(is_reported(detection, nullptr));
  EXPECT_TRUE(is_reported(detection, &pose)) << "found, though its pose is withheld";
  detection.reported = false;
  EXPECT_FALSE(is_reported(detection, nullptr));
  EXPECT_FALSE(is_reported(detection, &pose));
  pose.status = PoseStatus::kValid;
  EXPECT_TRUE(is_reported(detection, &pose));
}

TEST(IsReported, APoseTakesADetectionBackWhereItRefutesIt) {
  Detection detection;
  detection.score = 0.99F;
  ObjectPose pose;
  pose.status = PoseStatus::kRefuted;
  EXPECT_FALSE(is_reported(detection, &pose));
  pose.status = PoseStatus::kTooFewPoints;
  EXPECT_TRUE(is_reported(detection, &pose)) << "no pose was judged";
}

TEST(FindPose, GoesByTheDetectionNotByTheOrder) {
  ObjectPoses poses;
  poses.poses.resize(2);
  poses.poses[0].detection_index = 4;
  poses.poses[1].detection_index = 1;
  EXPECT_EQ(find_pose(poses, 1), &poses.poses[1]);
  EXPECT_EQ(find_pose(poses, 0), nullptr);
}

}  // namespace
}  // namespace houghstream
