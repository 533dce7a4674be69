#include "detector/group_schedule.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "detector/forest/forest.hpp"
#include "tests/expect_says.hpp"
#include "tests/test_files.hpp"

namespace houghstream {
namespace {

using Indices = std::vector<std::size_t>;

constexpr std::int64_t kStart = 5000000;   // microseconds
constexpr std::int64_t kInterval = 33333;  // of a camera of 30 Hz, microseconds

std::string object_of(std::size_t group) {
  return "object_" + std::to_string(group);
}

std::vector<Forest> make_groups(std::size_t count) {
  std::vector<Forest> groups(count);
  for (std::size_t i = 0; i < count; ++i) {
    ObjectClass object;
    object.class_id = static_cast<int>(i) + 1;
    object.name = object_of(i);
    groups[i].classes.push_back(object);
  }
  return groups;
}

Indices all_of(std::size_t count) {
  Indices all(count);
  std::iota(all.begin(), all.end(), 0);
  return all;
}

bool contains(const Indices& indices, std::size_t index) {
  return std::find(indices.begin(), indices.end(), index) != indices.end();
}

/// Returns what is detected where the objects of these groups are in view.
Detections detections_of(const FrameId& frame, const Indices& groups) {
  Detections found;
  found.frame = frame;
  for (const std::size_t group : groups) {
    Detection& detection = found.detections.emplace_back();
    detection.class_name = object_of(group);
  }
  return found;
}

/// Times of each group's searches, seconds, in frames that come at this interval, with the first one.
std::vector<std::vector<double>> searches(GroupSchedule& schedule, std::size_t groups, std::int64_t interval_us) {
  constexpr int kFrames = 300;
  std::vector<std::vector<double>> times(groups);
  for (int i = 0; i < kFrames; ++i) {
    for (const std::size_t group : schedule.select({"LEFT", kStart + i * interval_us}))
      times[group].push_back(1e-6 * static_cast<double>(i * interval_us));
  }
  return times;
}

double max_gap(const std::vector<double>& times) {
  double gap = 0.0;
  for (std::size_t i = 1; i < times.size(); ++i) gap = std::max(gap, times[i] - times[i - 1]);
  return gap;
}

TEST(GroupSchedule, InACamerasFirstFrameAllAreSearched) {
  GroupSchedule schedule(make_groups(9));
  EXPECT_EQ(schedule.select({"LEFT", kStart}), all_of(9));
  EXPECT_LT(schedule.select({"LEFT", kStart + kInterval}).size(), 9U);
  EXPECT_EQ(schedule.select({"RIGHT", kStart + kInterval}), all_of(9)) << "each camera has its own turn";
}

TEST(GroupSchedule, EachInactiveOneIsSearchedWithinTheIntervalOrInTheNextFrame) {
  for (const std::size_t count : {2U, 6U, 9U, 60U}) {
    for (const std::int64_t interval_us : {16667, 33333, 33334, 50000, 90000, 150000, 199000}) {
      const double limit_s = 0.2 + 1e-6 * static_cast<double>(interval_us);
      GroupSchedule schedule(make_groups(count));
      const std::vector<std::vector<double>> times = searches(schedule, count, interval_us);
      for (std::size_t i = 0; i < count; ++i)
        EXPECT_LT(max_gap(times[i]), limit_s) << "group " << i << " of " << count << ", " << interval_us << " us";
    }
  }
}

TEST(GroupSchedule, TheyAreSpreadEvenlyOverTheFrames) {
  GroupSchedule schedule(make_groups(9));
  schedule.select({"LEFT", kStart});
  std::size_t count = 0;
  for (int i = 1; i <= 300; ++i) {
    const Indices selected = schedule.select({"LEFT", kStart + i * kInterval});
    EXPECT_TRUE(selected.size() == 1 || selected.size() == 2) << selected.size();
    EXPECT_TRUE(std::is_sorted(selected.begin(), selected.end()));
    count += selected.size();
  }
  EXPECT_NEAR(static_cast<double>(count), 450.0, 10.0) << "of nine 1.5 a frame";
  GroupSchedule again(make_groups(9));
  for (const std::vector<double>& times : searches(again, 9, kInterval)) EXPECT_LT(max_gap(times), 0.2);
}

TEST(GroupSchedule, ThoseThatWereSearchedLongestAgoComeFirst) {
  GroupSchedule schedule(make_groups(5));
  const auto select = [&](int frame) { return schedule.select({"LEFT", kStart + frame * 50000}); };
  EXPECT_EQ(select(0), all_of(5));
  EXPECT_EQ(select(1), (Indices{0}));
  EXPECT_EQ(select(2), (Indices{1}));
  EXPECT_EQ(select(3), (Indices{2}));
  EXPECT_EQ(select(4), (Indices{3, 4}));
  EXPECT_EQ(select(5), (Indices{0}));
}

TEST(GroupSchedule, ASingleInactiveOneHasItsTurnOnceAnInterval) {
  GroupSchedule schedule(make_groups(2));
  int count = 0;
  for (int i = 0; i < 60; ++i) {
    const FrameId frame{"LEFT", kStart + i * kInterval};
    const Indices selected = schedule.select(frame);
    count += contains(selected, 0) ? 1 : 0;
    schedule.note(detections_of(frame, {1}));
  }
  EXPECT_EQ(count, 10) << "in two seconds";
}

TEST(GroupSchedule, OneIsSearchedInEveryFrame) {
  GroupSchedule schedule(make_groups(2));
  EXPECT_EQ(schedule.select({"LEFT", kStart}), all_of(2));
  for (int i = 1; i < 30; ++i) EXPECT_EQ(schedule.select({"LEFT", kStart + i * kInterval}).size(), 1U) << i;
}

TEST(GroupSchedule, APauseIsNotMadeUpFor) {
  GroupSchedule schedule(make_groups(9));
  schedule.select({"LEFT", kStart});
  EXPECT_EQ(schedule.select({"LEFT", kStart + 60000000}), all_of(9));
  EXPECT_LE(schedule.select({"LEFT", kStart + 60000000 + kInterval}).size(), 2U);
}

TEST(GroupSchedule, AnActiveOneIsSearchedInEveryFrameForASecond) {
  GroupSchedule schedule(make_groups(9));
  schedule.select({"LEFT", kStart});
  schedule.note(detections_of({"LEFT", kStart}, {7}));
  int missing = 0;
  for (int i = 1; i <= 60; ++i) {
    const std::int64_t passed_us = i * kInterval;
    const Indices selected = schedule.select({"LEFT", kStart + passed_us});
    if (passed_us <= 1000000) {
      EXPECT_TRUE(contains(selected, 7)) << i;
      EXPECT_LE(selected.size(), 3U) << "with one or two of eight inactive ones";
    } else {
      missing += contains(selected, 7) ? 0 : 1;
    }
  }
  EXPECT_GT(missing, 15) << "it has its turn as the others again";
}

TEST(GroupSchedule, ACandidateMakesItsGroupNotActive) {
  GroupSchedule schedule(make_groups(9));
  schedule.select({"LEFT", kStart});
  Detections found = detections_of({"LEFT", kStart}, {7});
  found.detections.at(0).reported = false;
  schedule.note(found);
  EXPECT_FALSE(contains(schedule.select({"LEFT", kStart + kInterval}), 7));
}

/// Returns the poses of these groups' objects.
ObjectPoses poses_of(const FrameId& frame, const Indices& groups, PoseStatus status) {
  ObjectPoses poses;
  poses.frame = frame;
  for (const std::size_t group : groups) {
    ObjectPose& pose = poses.poses.emplace_back();
    pose.class_name = object_of(group);
    pose.status = status;
  }
  return poses;
}

TEST(GroupSchedule, WhereThereArePosesTheseDecide) {
  GroupSchedule schedule(make_groups(9));
  schedule.select({"LEFT", kStart});
  schedule.note(poses_of({"LEFT", kStart}, {8}, PoseStatus::kValid));
  schedule.note(poses_of({"LEFT", kStart}, {6}, PoseStatus::kRejectedByOutline));
  schedule.note(detections_of({"LEFT", kStart}, {7}));
  EXPECT_EQ(schedule.select({"LEFT", kStart + kInterval}), (Indices{0, 8}));
  const std::int64_t later = kStart + 1100000;  // no poses have come for a second
  schedule.select({"LEFT", later});
  schedule.note(detections_of({"LEFT", later}, {7}));
  EXPECT_TRUE(contains(schedule.select({"LEFT", later + kInterval}), 7));
}

TEST(GroupSchedule, PosesWithoutAModelSayNothing) {
  GroupSchedule schedule(make_groups(9));
  schedule.select({"LEFT", kStart});
  schedule.note(poses_of({"LEFT", kStart}, {8}, PoseStatus::kNoModel));
  schedule.note(detections_of({"LEFT", kStart}, {7}));
  EXPECT_EQ(schedule.select({"LEFT", kStart + kInterval}), (Indices{0, 7}));
}

TEST(GroupSchedule, OthersStayInTimeWhileGroupsBecomeActive) {
  GroupSchedule schedule(make_groups(20));
  const auto select = [&](int frame) { return schedule.select({"LEFT", kStart + frame * 50000}); };
  for (int i = 0; i < 5; ++i) select(i);  // five a frame
  schedule.note(detections_of({"LEFT", kStart + 4 * 50000}, {10, 11, 12, 13, 14, 15, 16, 17, 18, 19}));
  const Indices next = select(5);
  EXPECT_FALSE(contains(next, 9)) << "three of ten a frame";
  EXPECT_TRUE(contains(select(6), 9)) << "0.2 s after the second frame";
}

TEST(GroupSchedule, WithAnIntervalOfZeroAllAreSearchedInEveryFrame) {
  GroupScheduleSettings settings;
  settings.interval_s = 0.0;
  GroupSchedule schedule(make_groups(9), settings);
  for (const std::int64_t passed_us : {0, 33333, 33333, 20000, 66666})
    EXPECT_EQ(schedule.select({"LEFT", kStart + passed_us}), all_of(9)) << passed_us;
}

TEST(GroupSchedule, FramesAsFarApartAsTheIntervalSearchAll) {
  GroupSchedule schedule(make_groups(9));
  for (int i = 0; i < 10; ++i) EXPECT_EQ(schedule.select({"LEFT", kStart + i * 200000}), all_of(9)) << i;
}

TEST(GroupSchedule, NoTimePassesByAFrameThatWasOvertaken) {
  GroupSchedule schedule(make_groups(9));
  schedule.select({"LEFT", kStart});
  schedule.note(detections_of({"LEFT", kStart}, {7}));
  EXPECT_EQ(schedule.select({"LEFT", kStart - 900000}), (Indices{7})) << "the active one";
  EXPECT_EQ(schedule.select({"LEFT", kStart}), (Indices{7}));
  EXPECT_EQ(schedule.select({"LEFT", kStart + kInterval}), (Indices{0, 7})) << "one interval has passed, not thirty";
}

TEST(GroupSchedule, TimesThatGoBackRestartTheCamera) {
  GroupSchedule schedule(make_groups(9));
  schedule.select({"LEFT", kStart});
  schedule.note(detections_of({"LEFT", kStart}, {7}));
  EXPECT_EQ(schedule.select({"LEFT", kStart - 1100000}), all_of(9));
  EXPECT_EQ(schedule.select({"LEFT", kStart - 1100000 + kInterval}), (Indices{0})) << "none is active any more";
}

TEST(GroupSchedule, OfACameraTooManyAllAreSearched) {
  GroupSchedule schedule(make_groups(9));
  for (std::size_t i = 0; i < GroupSchedule::kCameras; ++i) schedule.select({"FORGED_" + std::to_string(i), kStart});
  for (int i = 0; i < 3; ++i) {
    const FrameId frame{"LATE", kStart + i * kInterval};
    EXPECT_EQ(schedule.select(frame), all_of(9));
    schedule.note(detections_of(frame, {7}));
  }
  EXPECT_EQ(schedule.select({"FORGED_63", kStart + kInterval}), (Indices{0})) << "the others have theirs";
}

TEST(GroupSchedule, WhatNoGroupHasAndAnUnknownCameraChangeNothing) {
  GroupSchedule schedule(make_groups(9));
  schedule.note(detections_of({"LEFT", kStart}, {7}));
  EXPECT_EQ(schedule.select({"LEFT", kStart}), all_of(9));
  schedule.note(detections_of({"LEFT", kStart}, {9}));
  EXPECT_EQ(schedule.select({"LEFT", kStart + kInterval}), (Indices{0}));
}

TEST(GroupSchedule, TimesMayBeAny) {
  constexpr std::int64_t kFirst = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t kLast = std::numeric_limits<std::int64_t>::max();
  GroupSchedule schedule(make_groups(9));
  for (const std::int64_t utime : {kFirst, kLast, kFirst}) EXPECT_EQ(schedule.select({"LEFT", utime}), all_of(9));
  EXPECT_EQ(schedule.select({"LEFT", kFirst + kInterval}), (Indices{0}));
}

TEST(GroupSchedule, SettingsOutOfTheirRangeAreRefused) {
  GroupScheduleSettings settings;
  settings.interval_s = -0.1;
  expect_says(error_of([&] { GroupSchedule(make_groups(2), settings); }), {"schedule of groups: interval_s -0.1"});
}

}  // namespace
}  // namespace houghstream
