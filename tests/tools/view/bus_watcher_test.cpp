#include "tools/view/bus_watcher.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/bus/event_log.hpp"
#include "tests/tools/view/watched_bus.hpp"

namespace houghstream::view {
namespace {

TEST(BusWatcher, AFrameComesWithItsResults) {
  WatchedBus watched;
  watched.publish_frame(1);
  watched.publish_results(1);
  const std::optional<MatchedFrame> matched = watched.next();
  ASSERT_TRUE(matched.has_value());
  EXPECT_EQ(matched->id, (FrameId{channel::kFrame, 1}));
  const std::optional<FrameResult> found = matched->results.merge();
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->detections.detections.size(), 1U);
  EXPECT_TRUE(found->poses.has_value());
  EXPECT_FALSE(watched.watcher.next(std::chrono::milliseconds(0)).has_value());
}

TEST(BusWatcher, PosesHaveTheProbabilitiesThatCameBeforeThem) {
  WatchedBus watched;
  watched.publish_frame(1);
  Detections detections;
  detections.frame = {channel::kFrame, 1};
  detections.detections.resize(1);
  detections.detections[0].class_id = 1;
  detections.detections[0].class_name = "can";
  detections.detections[0].box_px = {10.0F, 10.0F, 20.0F, 20.0F};
  ObjectPoses poses;
  poses.frame = detections.frame;
  poses.poses.resize(1);
  poses.poses[0].class_name = "can";
  poses.poses[0].detection_index = 0;
  poses.poses[0].status = PoseStatus::kNotConverged;
  poses.poses[0].quality = 0.25F;
  poses.poses[0].shape_quality = 0.875F;
  watched.bus.publish(channel::kDetections, to_message(detections));
  watched.bus.publish(channel::kPoseProbabilities, probabilities_to_message(poses));
  watched.bus.publish(channel::kPoses, to_message(poses));
  const std::optional<MatchedFrame> matched = watched.next();
  ASSERT_TRUE(matched.has_value());
  const std::optional<FrameResult> found = matched->results.merge();
  ASSERT_TRUE(found.has_value() && found->poses.has_value());
  EXPECT_EQ(found->poses->poses.at(0).quality, 0.25F);
  EXPECT_EQ(found->poses->poses.at(0).shape_quality, 0.875F);
}

TEST(BusWatcher, RateAndFramesThatNeverArrivedAreCounted) {
  WatchedBus watched;
  watched.publish_frame(1);
  std::this_thread::sleep_for(std::chrono::milliseconds(2));
  watched.publish_frame(4);
  EXPECT_TRUE(WatchedBus::comes_true([&] { return watched.watcher.frames_lost() == 2; }));
  EXPECT_TRUE(WatchedBus::comes_true([&] { return watched.watcher.stream_state().frames_hz > 0.0; }));
}

TEST(BusWatcher, WhatIsNoMessageOfTheChannelDoesNotEndIt) {
  WatchedBus watched;
  const std::vector<std::uint8_t> rubbish(20, 7);
  for (const std::string& name :
       {channel::kFrame, channel::kDetections, channel::kPoses, channel::kStatus, channel::kTeaching}) {
    watched.bus.publish(name, {rubbish.data(), rubbish.size()}, 0);
  }
  watched.publish_frame(1);
  watched.publish_results(1);
  EXPECT_TRUE(watched.next().has_value());
  EXPECT_EQ(watched.last_words().frames_refused, 1) << "and counts the one that should have been a frame";
}

TEST(BusWatcher, ResultsThatAreTooLargeAreRefused) {
  WatchedBus watched;
  Detections many;
  many.frame = {channel::kFrame, 1};
  many.detections.resize(1);
  many.detections[0].class_name = std::string(std::size_t{2} << 20U, 'x');
  many.detections[0].box_px = {10.0F, 10.0F, 20.0F, 20.0F};
  watched.bus.publish(channel::kDetections, to_message(many));
  watched.publish_frame(1);
  watched.publish_results(1);
  const std::optional<MatchedFrame> matched = watched.next();
  ASSERT_TRUE(matched.has_value());
  EXPECT_EQ(matched->results.results().size(), 1U);
  EXPECT_NE(watched.last_words().last_error.find("expected at most 1048576"), std::string::npos);
}

TEST(BusWatcher, OfTwoCamerasOfEqualTimesOneIsShownAndNothingMixed) {
  WatchedBus watched("LEFT|RIGHT");
  for (std::int64_t i = 1; i <= 2; ++i) {
    for (const std::string camera : {"LEFT", "RIGHT"}) {
      watched.publish_frame(i, camera);
      watched.publish_results({camera, i}, camera == "LEFT" ? "bowl" : "can");
    }
    const std::optional<MatchedFrame> matched = watched.next();
    ASSERT_TRUE(matched.has_value());
    const std::string shown = i == 1 ? "LEFT" : "RIGHT";
    EXPECT_EQ(matched->id, (FrameId{shown, i}));
    EXPECT_EQ(matched->results.merge()->detections.detections.at(0).class_name, i == 1 ? "bowl" : "can");
    EXPECT_FALSE(watched.watcher.next(std::chrono::milliseconds(200)).has_value());
    watched.watcher.cameras().next();
  }
  EXPECT_EQ(watched.watcher.cameras().heard(), (std::vector<std::string>{"LEFT", "RIGHT"}));
  const status_t last = watched.last_words();
  EXPECT_EQ(last.frames_received, 4);
  EXPECT_EQ(last.frames_skipped, 2);
  EXPECT_EQ(last.frames_lost, 0) << "each camera has a numbering of its own";
}

TEST(BusWatcher, ATeachingIsHeard) {
  WatchedBus watched;
  Teaching mug;
  mug.name = "mug";
  mug.state = TeachingState::kFusing;
  watched.bus.publish(channel::kTeaching, to_message(mug));
  ASSERT_TRUE(WatchedBus::comes_true([&] { return watched.watcher.stream_state().teaching.has_value(); }));
  EXPECT_EQ(watched.watcher.stream_state().teaching->state, TeachingState::kFusing);
}

TEST(BusWatcher, ProcessesAreKnownByWhatTheySay) {
  WatchedBus watched;
  status_t status{};
  status.process = "hs-detect";
  status.frames_skipped = 3;
  watched.bus.publish(channel::kStatus, status);
  ASSERT_TRUE(WatchedBus::comes_true([&] { return !watched.watcher.stream_state().processes.empty(); }));
  const ProcessState heard = watched.watcher.stream_state().processes[0];
  EXPECT_EQ(heard.name, "hs-detect");
  EXPECT_EQ(heard.skipped, 3);
}

TEST(BusWatcher, SaysWhatBecameOfTheFrames) {
  WatchedBus watched;
  watched.publish_frame(1);
  watched.publish_results(1);
  const std::optional<MatchedFrame> matched = watched.next();
  ASSERT_TRUE(matched.has_value());
  watched.watcher.note_drawn(*matched);
  watched.watcher.note_skipped();
  watched.watcher.note_refused("no camera");
  const status_t last = watched.last_words();
  EXPECT_EQ(last.process, "hs-view");
  EXPECT_EQ(last.frames_received, 1);
  EXPECT_EQ(last.frames_skipped, 1);
  EXPECT_EQ(last.frames_refused, 1);
  EXPECT_EQ(last.last_error, "no camera");
}

TEST(BusWatcher, APreviewIsAJpegOfTheImage) {
  WatchedBus watched;
  watched.watcher.stop();  // from here on this thread receives
  image_t preview{};
  watched.bus.subscribe(channel::kPreview, [&](const ReceivedMessage& arrival) {
    preview.decode(arrival.bytes.data, 0, static_cast<int>(arrival.bytes.size));
  });
  watched.watcher.publish_preview(cv::Mat(40, 60, CV_8UC3, cv::Scalar(0, 0, 200)), 9);
  ASSERT_TRUE(watched.bus.handle(std::chrono::milliseconds(1000)));
  EXPECT_EQ(preview.utime, 9);
  EXPECT_EQ(cv::Size(preview.width, preview.height), cv::Size(60, 40));
  EXPECT_EQ(preview.pixelformat, image_t::PIXEL_FORMAT_MJPEG);
  EXPECT_EQ(preview.size, static_cast<std::int32_t>(preview.data.size()));
  ASSERT_GT(preview.data.size(), 2U);
  EXPECT_EQ(preview.data[0] << 8 | preview.data[1], 0xFFD8);
}

TEST(BusWatcher, ABusThatIsGoneDoesNotEndIt) {
  testing::internal::CaptureStderr();
  start_log("test", LogLevel::kInfo);
  {
    LcmBus bus("tcpq://127.0.0.1:1");  // without a server
    BusWatcher watcher(bus, channel::kFrame, {}, 1);
    EXPECT_FALSE(watcher.next(std::chrono::milliseconds(1300)).has_value());
    watcher.stop();
  }
  const std::string log = testing::internal::GetCapturedStderr();
  const std::size_t first = log.find("not connected");
  EXPECT_NE(first, std::string::npos) << log;
  EXPECT_EQ(log.find("not connected", first + 1), std::string::npos) << log;
}

TEST(BusWatcher, ALogIsNotWatched) {
  const auto file = std::filesystem::temp_directory_path() / ("bus_watcher_test." + std::to_string(getpid()));
  const std::uint8_t byte = 0;
  LogWriter writer(file);
  writer.write(0, "X", {&byte, 1});
  writer.close();
  LcmBus bus("file://" + file.string());
  EXPECT_THROW(BusWatcher(bus, channel::kFrame, {}, 1), InputError);
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace houghstream::view
