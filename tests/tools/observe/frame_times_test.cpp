#include "tools/observe/frame_times.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/host_clock.hpp"

namespace houghstream {
namespace {

FrameTimes::Time at_ms(int ms) {
  return FrameTimes::Time(std::chrono::seconds(1000)) + std::chrono::milliseconds(ms);
}

// Returns ten frames 100 ms apart; even ones are detected after 10 ms and have poses 5 ms later.
FrameTimes ten_frames() {
  FrameTimes times;
  for (int i = 0; i < 10; ++i) {
    times.note_frame({"LEFT", i}, at_ms(100 * i));
    if (i % 2 == 1) continue;
    times.note_detections({"LEFT", i}, at_ms(100 * i + 10));
    times.note_poses({"LEFT", i}, at_ms(100 * i + 15));
  }
  return times;
}

status_t detector_status(std::int64_t received, std::int64_t processed, std::int64_t skipped) {
  status_t status{};
  status.process = "hs-detect";
  status.frames_received = received;
  status.frames_processed = processed;
  status.frames_skipped = skipped;
  status.frames_lost = -1;
  return status;
}

TEST(FrameTimes, TheStartIsOnTheClockOfUtimes) {
  FrameTimes times;
  EXPECT_TRUE(times.summary(std::nullopt)["start_utime"].is_null());
  const std::int64_t before = utime_now();
  times.note_frame({"LEFT", 1}, FrameTimes::Time::clock::now());
  const std::int64_t after = utime_now();
  const std::int64_t start = times.summary(std::nullopt)["start_utime"];
  EXPECT_GE(start, before - 100000);
  EXPECT_LE(start, after + 100000);
}

TEST(FrameTimes, LatencyIsFromMessageToMessage) {
  const nlohmann::json summary = ten_frames().summary(std::nullopt);
  EXPECT_EQ(summary["frames_received"], 10);
  EXPECT_EQ(summary["frames_detected"], 5);
  EXPECT_EQ(summary["frames_with_poses"], 5);
  EXPECT_NEAR(summary["latency_ms"]["detect"]["p50"], 10.0, 1e-6);
  EXPECT_NEAR(summary["latency_ms"]["pose"]["p95"], 5.0, 1e-6);
  EXPECT_NEAR(summary["latency_ms"]["total"]["p99"], 15.0, 1e-6);
  EXPECT_NEAR(summary["frame_rate_hz"], 10.0, 1e-6);
  EXPECT_NEAR(summary["detection_rate_hz"], 5.0, 1e-6);
  EXPECT_TRUE(summary["frames_sent"].is_null());
  EXPECT_TRUE(summary["account"].is_null()) << "nobody has given an account";
}

TEST(FrameTimes, PosesThatComeBeforeDetectionsAnswerNone) {
  FrameTimes times;
  times.note_frame({"LEFT", 1}, at_ms(0));
  times.note_poses({"LEFT", 1}, at_ms(5));
  times.note_detections({"LEFT", 1}, at_ms(30));
  const nlohmann::json summary = times.summary(std::nullopt);
  EXPECT_NEAR(summary["latency_ms"]["total"]["p50"], 5.0, 1e-6);
  EXPECT_TRUE(summary["latency_ms"]["pose"]["p50"].is_null());
}

TEST(FrameTimes, TheWorldAfterAFrameIsToldApart) {
  FrameTimes times = ten_frames();
  EXPECT_EQ(times.summary(std::nullopt)["frames_with_objects"], 0);
  EXPECT_TRUE(times.summary(std::nullopt)["objects_latency_ms"]["p50"].is_null());
  for (int i = 0; i < 10; i += 2) times.note_objects({"LEFT", i}, at_ms(100 * i + 18));
  times.note_objects({"LEFT", 0}, at_ms(90));  // after another result of the same frame
  const nlohmann::json summary = times.summary(std::nullopt);
  EXPECT_EQ(summary["frames_with_objects"], 5);
  EXPECT_NEAR(summary["objects_latency_ms"]["p99"], 18.0, 1e-6);
  EXPECT_FALSE(summary["latency_ms"].contains("objects")) << "a stream need not have them";
}

TEST(FrameTimes, TheAccountAddsUpOrSaysThatItDoesNot) {
  FrameTimes times = ten_frames();
  times.note_status(detector_status(3, 1, 1));
  times.note_status(detector_status(9, 5, 4));
  nlohmann::json account = times.summary(10)["account"];
  EXPECT_EQ(account["lost"], 1);
  EXPECT_EQ(account["detected"], 5);
  EXPECT_EQ(account["skipped"], 4);
  EXPECT_TRUE(account["balanced"]);
  times.note_status(detector_status(9, 5, 2));
  account = times.summary(10)["account"];
  EXPECT_EQ(account["unaccounted"], 2);
  EXPECT_FALSE(account["balanced"]);
}

TEST(FrameTimes, CamerasOfEqualTimesAndSeveralDetectorsStaySeparate) {
  FrameTimes times = ten_frames();
  for (int i = 0; i < 10; ++i) times.note_frame({"RIGHT", i}, at_ms(100 * i + 1));
  times.note_detections({"RIGHT", 1}, at_ms(500));
  status_t left = detector_status(10, 5, 5);
  times.note_status(left);
  left.pid = 17;
  times.note_status(left);
  const nlohmann::json summary = times.summary(std::nullopt);
  EXPECT_EQ(summary["frames_received"], 20);
  EXPECT_EQ(summary["frames_detected"], 6);
  EXPECT_TRUE(summary["processes"].contains("hs-detect 0"));
  EXPECT_TRUE(summary["processes"].contains("hs-detect 17"));
  EXPECT_TRUE(summary["account"].is_null()) << "two detectors do not share one account";
}

TEST(FrameTimes, WithoutMessagesThereAreNoNumbers) {
  const nlohmann::json summary = FrameTimes().summary(5);
  EXPECT_EQ(summary["frames_received"], 0);
  EXPECT_TRUE(summary["latency_ms"]["detect"]["p50"].is_null());
  EXPECT_TRUE(summary["frame_rate_hz"].is_null());
  EXPECT_EQ(FrameTimes().csv(), "utime,channel,t_frame,t_detections,t_poses,t_objects\n");
}

TEST(FrameTimes, ForgedProcessesDoNotFillTheMemory) {
  FrameTimes times;
  for (int pid = 1; pid <= 100; ++pid) {
    status_t status = detector_status(1, 1, 0);
    status.pid = pid;
    times.note_status(status);
  }
  EXPECT_EQ(times.summary(std::nullopt)["processes"].size(), 64U);
}

TEST(FrameTimes, RowsLeaveEmptyWhatHasNotCome) {
  FrameTimes times;
  times.note_frame({"LEFT", 7}, at_ms(0));
  times.note_frame({"LEFT", 7}, at_ms(500));
  times.note_frame({"LEFT", 8}, at_ms(33));
  times.note_detections({"LEFT", 8}, at_ms(50));
  times.note_objects({"LEFT", 8}, at_ms(80));
  EXPECT_EQ(times.csv(),
            "utime,channel,t_frame,t_detections,t_poses,t_objects\n7,LEFT,0.000000,,,\n8,LEFT,0.033000,0.050000,,"
            "0.080000\n");
  EXPECT_EQ(times.frames(), 2U);
}

TEST(FrameTimes, ObjectsOfAFrameThatNobodySawAreTheFirstArrival) {
  FrameTimes times;
  times.note_objects({"LEFT", 7}, at_ms(0));
  EXPECT_EQ(times.csv(), "utime,channel,t_frame,t_detections,t_poses,t_objects\n7,LEFT,,,,0.000000\n");
}

}  // namespace
}  // namespace houghstream
