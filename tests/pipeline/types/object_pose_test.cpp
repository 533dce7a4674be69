#include "pipeline/types/object_pose.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

namespace houghstream {
namespace {

TEST(PoseStatus, EachHasWordsOfItsOwn) {
  std::set<std::string> words;
  for (int status = 0; status <= static_cast<int>(PoseStatus::kOccluded); ++status) {
    words.insert(to_string(static_cast<PoseStatus>(status)));
  }
  EXPECT_EQ(words.size(), 11U);
  EXPECT_EQ(words.count("unknown"), 0U);
  EXPECT_STREQ(to_string(static_cast<PoseStatus>(99)), "unknown");
}

TEST(IsReported, ACandidateIsConfirmedByAValidPoseAlone) {
  Detection detection;
  ObjectPose pose;
  pose.status = PoseStatus::kRejectedByDepth;
  pose.quality = 0.5F;
  detection.score = 0.7F;
  EXPECT_TRUE(is_reported(detection, nullptr));
  EXPECT_TRUE(is_reported(detection, &pose)) << "found, though its pose is withheld";
  detection.reported = false;
  EXPECT_FALSE(is_reported(detection, nullptr));
  EXPECT_FALSE(is_reported(detection, &pose));
  pose.status = PoseStatus::kValid;
  EXPECT_TRUE(is_reported(detection, &pose));
}

TEST(IsReported, ADetectionThatIsNotSureIsRefutedByAPoseThatIsContradicted) {
  Detection detection;
  detection.score = 0.7F;
  ObjectPose pose;
  pose.status = PoseStatus::kRejectedByColour;
  pose.quality = 0.001F;
  EXPECT_FALSE(is_reported(detection, &pose));
  pose.status = PoseStatus::kTooFewPoints;
  EXPECT_TRUE(is_reported(detection, &pose)) << "no pose was judged";
  pose.status = PoseStatus::kRejectedByColour;
  pose.quality = 0.2F;
  EXPECT_FALSE(is_reported(detection, &pose));
  detection.score = 0.95F;
  EXPECT_TRUE(is_reported(detection, &pose)) << "nearly sure by itself";
}

TEST(PresenceProbability, RisesWithScoreAndQualityAndStaysOne) {
  EXPECT_GT(presence_probability(0.9F, 0.5F), presence_probability(0.6F, 0.5F));
  EXPECT_GT(presence_probability(0.6F, 0.9F), presence_probability(0.6F, 0.5F));
  EXPECT_NEAR(presence_probability(0.5F, 0.5F), 1.0F / (1.0F + std::exp(-0.27F)), 1e-6F);
  for (const float end : {0.0F, 1.0F}) {
    EXPECT_GT(presence_probability(end, end), 0.0F);
    EXPECT_LT(presence_probability(end, end), 1.0F);
  }
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
