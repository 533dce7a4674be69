#include "pipeline/types/frame_results.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"

namespace houghstream {
namespace {

const FrameId kFrame{"LEFT", 5};

Detection found(const std::string& object, float score) {
  Detection detection;
  detection.class_name = object;
  detection.score = score;
  return detection;
}

/// Poses of these detections, one for each; the inliers tell which one.
ObjectPoses poses_of(const Detections& detections, int inliers) {
  ObjectPoses poses{detections.frame, {}, detections.stages};
  for (std::size_t i = 0; i < detections.detections.size(); ++i) {
    ObjectPose pose;
    pose.class_name = detections.detections[i].class_name;
    pose.detection_score = detections.detections[i].score;
    pose.detection_index = static_cast<int>(i);
    pose.inliers = inliers++;
    poses.poses.push_back(pose);
  }
  poses.stages.push_back({"pose.estimate", 7});
  return poses;
}

const Detections kBowls{kFrame, {found("bowl", 0.9F), found("bowl", 0.4F)}, {{"capture", 1}, {"detect", 2}}};
const Detections kCan{kFrame, {found("can", 0.6F)}, {{"capture", 1}, {"detect", 3}}};

TEST(FrameResults, OneResultIsWhatItIs) {
  FrameResults results;
  EXPECT_FALSE(results.merge().has_value());
  results.add(kBowls);
  EXPECT_FALSE(results.has_all_poses());
  EXPECT_FALSE(results.merge()->poses.has_value());
  results.add(poses_of(kBowls, 10));
  EXPECT_TRUE(results.has_all_poses());
  EXPECT_EQ(results.merge()->detections.stages.size(), 2U);
  EXPECT_EQ(results.merge()->poses->poses.at(1).inliers, 11);
}

TEST(FrameResults, TwoDetectorsAreJoinedStrongestFirstEachWithItsOwnPoses) {
  FrameResults results;
  results.add(poses_of(kCan, 20));  // in any order
  results.add(kBowls);
  EXPECT_EQ(results.unmatched().size(), 1U);
  results.add(kCan);
  EXPECT_TRUE(results.unmatched().empty());
  results.add(poses_of(kBowls, 10));
  const std::optional<FrameResult> all = results.merge();
  ASSERT_EQ(all->detections.detections.size(), 3U);
  EXPECT_EQ(all->detections.detections[1].class_name, "can");
  ASSERT_EQ(all->poses->poses.size(), 3U);
  const int inliers[] = {10, 20, 11};
  for (int i = 0; i < 3; ++i) {
    const ObjectPose& pose = all->poses->poses[static_cast<std::size_t>(i)];
    EXPECT_EQ(pose.detection_index, i);
    EXPECT_EQ(pose.inliers, inliers[i]);
  }
  EXPECT_EQ(all->detections.stages.size(), 3U) << "the frame's own stage once";
  EXPECT_EQ(all->poses->stages.size(), 5U);
}

TEST(FrameResults, PosesOfOneDetectorAloneStayWithItsDetections) {
  FrameResults results;
  results.add(kBowls);
  results.add(kCan);
  results.add(poses_of(kCan, 20));
  EXPECT_FALSE(results.has_all_poses());
  const std::optional<FrameResult> all = results.merge();
  ASSERT_EQ(all->poses->poses.size(), 1U);
  EXPECT_EQ(all->poses->poses[0].detection_index, 1);
}

TEST(FrameResults, EmptyResultsHaveEmptyPoses) {
  const Detections none{kFrame, {}, {}};
  FrameResults results;
  results.add(kBowls);
  results.add(none);
  results.add(poses_of(none, 0));
  EXPECT_FALSE(results.has_all_poses()) << "they are not the bowls'";
  results.add(poses_of(kBowls, 10));
  EXPECT_TRUE(results.has_all_poses());
}

TEST(FrameResults, ALogThatIsPlayedAgainCountsOnce) {
  FrameResults results;
  for (const int inliers : {10, 30}) {
    results.add(kBowls);
    results.add(poses_of(kBowls, inliers));
  }
  EXPECT_EQ(results.results().size(), 1U);
  EXPECT_EQ(results.merge()->poses->poses.at(0).inliers, 30) << "the last counts";
}

TEST(FrameResults, FollowedPosesStandBesideTheAnswers) {
  ObjectPoses followed = poses_of(kBowls, 7);
  for (ObjectPose& pose : followed.poses) pose.detection_index = -1;
  FrameResults results;
  EXPECT_FALSE(results.followed().has_value());
  results.add(followed);
  results.add(kBowls);
  results.add(poses_of(kBowls, 30));
  EXPECT_EQ(results.merge()->poses->poses.at(0).inliers, 30);
  EXPECT_EQ(results.followed()->poses.at(0).inliers, 7);
  EXPECT_TRUE(results.unmatched().empty());

  FrameResults nothing;
  nothing.add(ObjectPoses{kBowls.frame, {}, {{kFollowingStage, 5}}});
  nothing.add(kBowls);
  EXPECT_TRUE(nothing.followed()->poses.empty());
  EXPECT_TRUE(nothing.unmatched().empty()) << "nothing is followed, which is no answer to detections";
}

TEST(FrameResults, AnAnswerOfAnotherHostsPosesWithoutTheModelsDoesNotTakeThePlaceOfOneWithThem) {
  ObjectPoses with = poses_of(kBowls, 10);
  with.poses[0].status = PoseStatus::kValid;
  ObjectPoses without = poses_of(kBowls, 30);
  for (ObjectPose& pose : without.poses) pose.status = PoseStatus::kNoModel;
  for (const bool first : {true, false}) {
    FrameResults results;
    results.add(kBowls);
    results.add(first ? with : without);
    results.add(first ? without : with);
    EXPECT_EQ(results.merge()->poses->poses.at(1).inliers, 11);
  }
}

TEST(FrameResults, OtherPosesAnswerNothing) {
  ObjectPoses other_frame = poses_of(kBowls, 0);
  other_frame.frame.channel = "RIGHT";
  ObjectPoses no_such_place = poses_of(kBowls, 0);
  no_such_place.poses[0].detection_index = 2;
  EXPECT_TRUE(is_result_of(poses_of(kBowls, 0), kBowls));
  EXPECT_FALSE(is_result_of(other_frame, kBowls));
  EXPECT_FALSE(is_result_of(no_such_place, kBowls));
  EXPECT_FALSE(is_result_of(poses_of(kCan, 0), kBowls));
}

TEST(FrameResults, MoreThanAnybodysDetectorsAreRefused) {
  FrameResults results;
  for (std::size_t i = 0; i < FrameResults::kMax; ++i)
    results.add(Detections{kFrame, {found("can", static_cast<float>(i))}, {}});
  EXPECT_NO_THROW(results.add(Detections{kFrame, {found("can", 3.0F)}, {}})) << "played again";
  EXPECT_THROW(results.add(kBowls), InputError);
  FrameResults early;
  for (std::size_t i = 0; i < FrameResults::kMax; ++i) early.add(poses_of(kCan, 1));
  EXPECT_THROW(early.add(poses_of(kCan, 1)), InputError);
}

}  // namespace
}  // namespace houghstream
