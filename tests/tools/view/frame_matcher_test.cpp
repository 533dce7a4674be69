#include "tools/view/frame_matcher.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"

namespace houghstream::view {
namespace {

constexpr std::int64_t kMs = 1000;

Detections detections_of(std::int64_t utime) {
  return Detections{{"TEST", utime}, {}, {}};
}

ObjectPoses poses_of(std::int64_t utime) {
  return ObjectPoses{{"TEST", utime}, {}, {}};
}

TEST(FrameMatcher, FrameComesOutWithItsOwnResultsOnceBothAreThere) {
  FrameMatcher matcher({});
  matcher.add_frame({"TEST", 100}, {42}, 0);
  EXPECT_FALSE(matcher.next(1 * kMs));
  matcher.add_detections(detections_of(100), 20 * kMs);
  EXPECT_FALSE(matcher.next(20 * kMs));
  matcher.add_poses(poses_of(100), 33 * kMs);
  const auto matched = matcher.next(34 * kMs);
  ASSERT_TRUE(matched);
  EXPECT_EQ(matched->frame_bytes, std::vector<std::uint8_t>{42});
  EXPECT_EQ(matched->results.merge()->detections.frame.utime, 100);
  EXPECT_EQ(matched->results.merge()->poses->frame.utime, 100);
  EXPECT_DOUBLE_EQ(matched->detect_latency_ms, 20.0);
  EXPECT_DOUBLE_EQ(matched->pose_latency_ms, 33.0);
  EXPECT_FALSE(matcher.next(35 * kMs));
}

TEST(FrameMatcher, AFrameWithFollowedPosesWaitsForNoDetections) {
  FrameMatcher matcher({});
  matcher.add_detections(detections_of(50), 0);
  matcher.add_frame({"TEST", 100}, {42}, 0);
  EXPECT_FALSE(matcher.next(1 * kMs));
  ObjectPoses followed = poses_of(100);
  followed.stages = {{kFollowingStage, 2}};
  matcher.add_poses(followed, 6 * kMs);
  const auto matched = matcher.next(7 * kMs);
  ASSERT_TRUE(matched);
  EXPECT_TRUE(matched->results.followed().has_value());
  EXPECT_DOUBLE_EQ(matched->pose_latency_ms, 6.0);
}

TEST(FrameMatcher, ResultsOfUnknownFramesAreIgnored) {
  FrameMatcher matcher({});
  matcher.add_detections(detections_of(1), 0);
  matcher.add_poses(poses_of(1), 0);
  EXPECT_FALSE(matcher.next(10 * kMs));
}

TEST(FrameMatcher, HandsOutAtMostTheRate) {
  MatchSettings settings;
  settings.rate_hz = 10.0;
  FrameMatcher matcher(settings);
  int drawn = 0;
  for (std::int64_t i = 0; i < 60; ++i) {  // two seconds at 30 Hz
    const std::int64_t now = i * 33'333;
    matcher.add_frame({"TEST", i}, {}, now);
    matcher.add_detections(detections_of(i), now + 10 * kMs);
    matcher.add_poses(poses_of(i), now + 15 * kMs);
    if (matcher.next(now + 16 * kMs)) ++drawn;
  }
  EXPECT_EQ(drawn, 20);
  EXPECT_FALSE(matcher.next(10'000 * kMs));
  EXPECT_EQ(matcher.passed_over(), 40);
}

TEST(FrameMatcher, PassedOverFramesAreNotShownWhileTheDetectorRuns) {
  FrameMatcher matcher({});
  matcher.add_frame({"TEST", 1}, {}, 0);
  matcher.add_frame({"TEST", 2}, {}, 600 * kMs);
  matcher.add_detections(detections_of(2), 610 * kMs);
  matcher.add_poses(poses_of(2), 620 * kMs);
  EXPECT_EQ(matcher.next(630 * kMs)->id.utime, 2);
  EXPECT_FALSE(matcher.next(640 * kMs));
}

TEST(FrameMatcher, WithoutPoseProcessDetectionsAreShownAfterTheWait) {
  FrameMatcher matcher({});
  matcher.add_frame({"TEST", 1}, {}, 0);
  matcher.add_detections(detections_of(1), 20 * kMs);
  EXPECT_FALSE(matcher.next(1900 * kMs));
  const auto matched = matcher.next(2001 * kMs);
  ASSERT_TRUE(matched);
  ASSERT_TRUE(matched->results.merge());
  EXPECT_FALSE(matched->results.merge()->poses);
}

TEST(FrameMatcher, WithoutAnyResultsFramesAreShownBare) {
  FrameMatcher matcher({});
  matcher.add_frame({"TEST", 1}, {}, 0);
  EXPECT_FALSE(matcher.next(1900 * kMs));
  const auto matched = matcher.next(2001 * kMs);
  ASSERT_TRUE(matched);
  EXPECT_FALSE(matched->results.merge());
}

Detections one(const FrameId& frame, const std::string& object) {
  Detection detection;
  detection.class_name = object;
  return {frame, {detection}, {}};
}

ObjectPoses pose_of(const FrameId& frame, const std::string& object) {
  ObjectPose pose;
  pose.class_name = object;
  pose.detection_index = 0;
  return {frame, {pose}, {}};
}

TEST(FrameMatcher, FramesOfEqualTimesKeepTheirOwnResults) {
  MatchSettings settings;
  settings.rate_hz = 1000.0;
  FrameMatcher matcher(settings);
  const FrameId left{"LEFT", 5};
  const FrameId right{"RIGHT", 5};
  matcher.add_frame(left, {1}, 0);
  matcher.add_frame(right, {2}, 1 * kMs);
  for (const FrameId& frame : {right, left}) {
    matcher.add_detections(one(frame, frame.channel), 10 * kMs);
    matcher.add_poses(pose_of(frame, frame.channel), 20 * kMs);
  }
  for (const FrameId& frame : {left, right}) {
    const std::optional<MatchedFrame> matched = matcher.next(21 * kMs);
    ASSERT_TRUE(matched);
    EXPECT_EQ(matched->id, frame);
    EXPECT_EQ(matched->frame_bytes[0], frame == left ? 1 : 2);
    EXPECT_EQ(matched->results.merge()->detections.detections.at(0).class_name, frame.channel);
    EXPECT_EQ(matched->results.merge()->poses->poses.at(0).class_name, frame.channel);
  }
}

TEST(FrameMatcher, AFrameWaitsForAllDetectorsOfItsCameraButNotForEver) {
  MatchSettings settings;
  settings.rate_hz = 1000.0;
  FrameMatcher matcher(settings);
  const auto add = [&](std::int64_t i, const std::string& object, std::int64_t now) {
    matcher.add_detections(one({"LEFT", i}, object), now);
    matcher.add_poses(pose_of({"LEFT", i}, object), now);
  };
  matcher.add_frame({"LEFT", 1}, {}, 0);
  add(1, "bowl", 10 * kMs);
  EXPECT_TRUE(matcher.next(11 * kMs)) << "nothing has told yet of a second detector";
  add(1, "can", 30 * kMs);
  matcher.add_frame({"LEFT", 2}, {}, 100 * kMs);
  add(2, "can", 110 * kMs);
  EXPECT_FALSE(matcher.next(111 * kMs));
  add(2, "bowl", 130 * kMs);
  const std::optional<MatchedFrame> both = matcher.next(131 * kMs);
  ASSERT_TRUE(both);
  EXPECT_EQ(both->results.merge()->detections.detections.size(), 2U);
  matcher.add_frame({"LEFT", 3}, {}, 200 * kMs);
  add(3, "bowl", 210 * kMs);
  EXPECT_FALSE(matcher.next(699 * kMs));
  EXPECT_TRUE(matcher.next(701 * kMs)) << "the other one has skipped this frame";
}

TEST(FrameMatcher, WhatWaitsHasSoManyBytesAndTheOldestGoes) {
  MatchSettings settings;
  settings.kept_bytes = 100;
  FrameMatcher matcher(settings);
  matcher.add_frame({"TEST", 3}, std::vector<std::uint8_t>(40), 0);
  matcher.add_frame({"TEST", 1}, std::vector<std::uint8_t>(40), 100 * kMs);
  EXPECT_EQ(matcher.passed_over(), 0);
  matcher.add_frame({"TEST", 2}, std::vector<std::uint8_t>(40), 200 * kMs);
  EXPECT_EQ(matcher.passed_over(), 1) << "the one that came first";
  matcher.add_detections(detections_of(2), 210 * kMs, 30);
  EXPECT_EQ(matcher.passed_over(), 2) << "results have bytes too";
  matcher.add_poses(poses_of(2), 220 * kMs, 31);
  const std::optional<MatchedFrame> none = matcher.next(221 * kMs);
  EXPECT_FALSE(none) << "there was no room for its poses";
  matcher.add_poses(poses_of(2), 230 * kMs, 30);
  ASSERT_TRUE(matcher.next(231 * kMs));
  matcher.add_frame({"TEST", 4}, std::vector<std::uint8_t>(400), 400 * kMs);
  EXPECT_EQ(matcher.passed_over(), 2) << "one stays, however large";
}

TEST(MatchedFrameQueue, HoldsSoManyFramesAndSoManyBytes) {
  MatchedFrameQueue queue(2, 100);
  const auto frame = [](std::int64_t utime, std::size_t bytes) {
    MatchedFrame out;
    out.id.utime = utime;
    out.bytes = bytes;
    return out;
  };
  EXPECT_EQ(queue.push(frame(1, 10)), 0);
  EXPECT_EQ(queue.push(frame(2, 10)), 0);
  EXPECT_EQ(queue.push(frame(3, 10)), 1) << "too many";
  EXPECT_EQ(queue.push(frame(4, 95)), 2) << "too many bytes";
  EXPECT_EQ(queue.push(frame(5, 500)), 1);
  EXPECT_EQ(queue.pop(std::chrono::milliseconds(0))->id.utime, 5);
  EXPECT_EQ(queue.push(frame(6, 100)), 0);
}

TEST(FrameMatcher, AbsurdRateIsRefused) {
  MatchSettings settings;
  settings.rate_hz = 0.0;
  EXPECT_THROW(FrameMatcher{settings}, InputError);
}

}  // namespace
}  // namespace houghstream::view
