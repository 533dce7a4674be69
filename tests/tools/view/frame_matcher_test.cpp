#include "tools/view/frame_matcher.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"

namespace houghstream {
namespace {

constexpr std::int64_t kMs = 1000;

Detections detections_of(std::int64_t utime) {
  return Detections{utime, "TEST", {}, {}};
}

ObjectPoses poses_of(std::int64_t utime) {
  return ObjectPoses{utime, "TEST", {}, {}};
}

TEST(FrameMatcher, FrameComesOutWithItsOwnResultsOnceBothAreThere) {
  FrameMatcher matcher({});
  matcher.add_frame({42}, 100, 0);
  EXPECT_FALSE(matcher.next(1 * kMs));
  matcher.add_detections(detections_of(100), 20 * kMs);
  EXPECT_FALSE(matcher.next(20 * kMs));
  matcher.add_poses(poses_of(100), 33 * kMs);
  const auto matched = matcher.next(34 * kMs);
  ASSERT_TRUE(matched);
  EXPECT_EQ(matched->frame_bytes, std::vector<std::uint8_t>{42});
  EXPECT_EQ(matched->detections->utime, 100);
  EXPECT_EQ(matched->poses->utime, 100);
  EXPECT_DOUBLE_EQ(matched->detect_latency_ms, 20.0);
  EXPECT_DOUBLE_EQ(matched->pose_latency_ms, 33.0);
  EXPECT_FALSE(matcher.next(35 * kMs));
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
    matcher.add_frame({}, i, now);
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
  matcher.add_frame({}, 1, 0);
  matcher.add_frame({}, 2, 600 * kMs);
  matcher.add_detections(detections_of(2), 610 * kMs);
  matcher.add_poses(poses_of(2), 620 * kMs);
  EXPECT_EQ(matcher.next(630 * kMs)->utime, 2);
  EXPECT_FALSE(matcher.next(640 * kMs));
}

TEST(FrameMatcher, WithoutPoseProcessDetectionsAreShownAfterTheWait) {
  FrameMatcher matcher({});
  matcher.add_frame({}, 1, 0);
  matcher.add_detections(detections_of(1), 20 * kMs);
  EXPECT_FALSE(matcher.next(1900 * kMs));
  const auto matched = matcher.next(2001 * kMs);
  ASSERT_TRUE(matched);
  EXPECT_TRUE(matched->detections);
  EXPECT_FALSE(matched->poses);
}

TEST(FrameMatcher, WithoutAnyResultsFramesAreShownBare) {
  FrameMatcher matcher({});
  matcher.add_frame({}, 1, 0);
  EXPECT_FALSE(matcher.next(1900 * kMs));
  const auto matched = matcher.next(2001 * kMs);
  ASSERT_TRUE(matched);
  EXPECT_FALSE(matched->detections);
}

TEST(FrameMatcher, AbsurdRateIsRefused) {
  MatchSettings settings;
  settings.rate_hz = 0.0;
  EXPECT_THROW(FrameMatcher{settings}, InputError);
}

}  // namespace
}  // namespace houghstream
