#include "pipeline/process/detect_process.hpp"

#include <houghstream/status_t.hpp>
#include <mutex>

#include "pipeline/base/checks.hpp"
#include "tests/pipeline/process_test.hpp"

namespace houghstream {
namespace {

using std::chrono::milliseconds;

Detections find_nothing(const RgbdFrame& frame) {
  Detections none;
  none.stages = frame.stages;
  return none;
}

images_t frame_message(std::int64_t utime, std::int64_t sequence) {
  return to_message(make_test_frame(utime), WireFormat{}, sequence);
}

std::function<void(LcmBus&)> process_with(const std::function<Detections(const RgbdFrame&)>& detect) {
  return [detect](LcmBus& bus) { run_detect_process(bus, DetectProcessOptions{}, detect); };
}

TEST(DetectProcess, PublishesEmptyResultsToo) {
  ProcessOnMemq test({channel::kDetections, channel::kStatus});
  test.start(process_with(find_nothing));
  test.bus.publish(channel::kFrame, frame_message(1000, 0));
  ASSERT_TRUE(test.wait_for(channel::kDetections, 1));
  const auto detections = test.at<detections_t>(channel::kDetections, 0);
  EXPECT_EQ(detections.utime, 1000);
  EXPECT_EQ(detections.n_detections, 0);
  EXPECT_EQ(detections.source_channel, "OPENNI_FRAME");
  ASSERT_EQ(detections.n_stages, 2);
  EXPECT_EQ(detections.stages[1].stage, "detect.decode");
  test.stop();
  EXPECT_EQ(test.last<status_t>(channel::kStatus).frames_processed, 1);
}

TEST(DetectProcess, TakesTheNewestAndAccountsForTheRest) {
  ProcessOnMemq test({channel::kDetections, channel::kStatus});
  test.start(process_with([](const RgbdFrame& frame) {
    std::this_thread::sleep_for(milliseconds(60));
    return find_nothing(frame);
  }));
  constexpr std::int64_t kFrames = 30;
  for (std::int64_t i = 0; i < kFrames; ++i) {
    if (i != 7) test.bus.publish(channel::kFrame, frame_message(1000 + i, i));
    std::this_thread::sleep_for(milliseconds(10));
  }
  const auto newest = [&] { return test.last<detections_t>(channel::kDetections).utime; };
  ASSERT_TRUE(test.wait_for(channel::kDetections, 1));
  for (int i = 0; i < 200 && newest() != 1000 + kFrames - 1; ++i) std::this_thread::sleep_for(milliseconds(10));
  EXPECT_EQ(newest(), 1000 + kFrames - 1) << "the last frame has to be worked on";
  test.stop();
  const auto status = test.last<status_t>(channel::kStatus);
  EXPECT_EQ(status.frames_received, kFrames - 1);
  EXPECT_EQ(status.frames_lost, 1);
  EXPECT_GT(status.frames_skipped, 10);
  EXPECT_EQ(status.frames_processed + status.frames_skipped, status.frames_received);
  EXPECT_EQ(static_cast<std::int64_t>(test.count(channel::kDetections)), status.frames_processed);
}

TEST(DetectProcess, HearsWhatIsKnownOfACamerasColours) {
  ProcessOnMemq test({channel::kDetections, channel::kStatus});
  std::mutex mutex;
  std::vector<CameraChroma> heard;
  DetectProcessOptions options;
  options.on_camera_colours = [&](const CameraChroma& colours) {
    const std::lock_guard<std::mutex> lock(mutex);
    heard.push_back(colours);
  };
  test.start([&](LcmBus& bus) { run_detect_process(bus, options, find_nothing); });
  ChromaPair pair;
  pair.class_name = "bowl";
  pair.probability = 0.9;
  camera_colours_t bad = to_message(CameraChroma{{"LEFT", 5}, {pair}});
  bad.probability[0] = 2.0F;
  test.bus.publish(channel::kCameraColours, bad);
  test.bus.publish(channel::kCameraColours, to_message(CameraChroma{{"LEFT", 6}, {pair}}));
  test.bus.publish(channel::kFrame, frame_message(1000, 0));
  ASSERT_TRUE(test.wait_for(channel::kDetections, 1)) << "bad colours end nothing";
  test.stop();
  const std::lock_guard<std::mutex> lock(mutex);
  ASSERT_EQ(heard.size(), 1U);
  EXPECT_EQ(heard.front().frame, (FrameId{"LEFT", 6}));
}

TEST(DetectProcess, ABudgetSkipsFramesUntilSomethingThatWasFollowedIsLost) {
  ProcessOnMemq test({channel::kDetections, channel::kStatus});
  DetectProcessOptions options;
  options.max_rate_hz = 1.0;
  test.start([&](LcmBus& bus) { run_detect_process(bus, options, find_nothing); });
  const auto send = [&](std::int64_t utime) {
    test.bus.publish(channel::kFrame, frame_message(utime, utime));
    std::this_thread::sleep_for(milliseconds(60));
  };
  ObjectPose pose;
  pose.class_name = "bowl";
  pose.status = PoseStatus::kOccluded;
  ObjectPoses poses{{channel::kFrame, 0}, {pose}, {}};
  send(1000000);
  send(1400000);
  EXPECT_EQ(test.count(channel::kDetections), 2U) << "every frame of the first half second is looked at";
  test.bus.publish(channel::kPoses, to_message(poses));
  send(1500000);
  EXPECT_EQ(test.count(channel::kDetections), 2U) << "what is hidden is not looked for";
  poses.poses[0].status = PoseStatus::kRejectedByDepth;
  poses.poses[0].detection_index = 0;
  test.bus.publish(channel::kPoses, to_message(poses));
  send(1600000);
  EXPECT_EQ(test.count(channel::kDetections), 2U) << "an answer to a detection is no loss";
  poses.poses[0].detection_index = -1;
  test.bus.publish(channel::kPoses, to_message(poses));
  send(1700000);
  send(1800000);
  send(2700000);
  test.stop();
  ASSERT_EQ(test.count(channel::kDetections), 4U);
  EXPECT_EQ(test.at<detections_t>(channel::kDetections, 2).utime, 1700000);
  EXPECT_EQ(test.at<detections_t>(channel::kDetections, 3).utime, 2700000);
  const auto status = test.last<status_t>(channel::kStatus);
  EXPECT_EQ(status.frames_received, 7);
  EXPECT_EQ(status.frames_skipped, 3);
}

TEST(DetectProcess, FramesThatCannotBeDecodedOrThatTheDetectorRefusesAreReportedAndDropped) {
  ProcessOnMemq test({channel::kDetections, channel::kStatus});
  test.start(process_with([](const RgbdFrame& frame) {
    if (frame.id.utime == 4) fail("the detector refuses frame 4");
    return find_nothing(frame);
  }));
  const auto send = [&](const images_t& message) {
    test.bus.publish(channel::kFrame, message);
    std::this_thread::sleep_for(milliseconds(150));
  };
  images_t truncated = frame_message(1, 0);
  truncated.images[0].data.resize(100);
  truncated.images[0].size = 100;
  send(truncated);
  images_t no_camera = frame_message(2, 1);
  no_camera.images[0].metadata.clear();
  no_camera.images[0].nmetadata = 0;
  send(no_camera);
  send(frame_message(4, 3));
  send(frame_message(5, 4));
  ASSERT_TRUE(test.wait_for(channel::kDetections, 1));
  test.stop();
  EXPECT_EQ(test.count(channel::kDetections), 1U);
  const auto status = test.last<status_t>(channel::kStatus);
  EXPECT_EQ(status.frames_received, 4);
  EXPECT_EQ(status.frames_refused, 3);
  EXPECT_EQ(status.frames_processed, 1);
  EXPECT_EQ(status.last_error, "the detector refuses frame 4");
}

// openni2-camera-lcm and the bot_core drivers send such frames: without metadata and frame counter.
TEST(DetectProcess, FramesOfOtherDriversAreWorkedOnWithTheCameraOption) {
  ProcessOnMemq test({channel::kDetections, channel::kStatus});
  DetectProcessOptions options;
  options.camera = make_test_frame(1).camera;
  Camera seen;
  test.start([&](LcmBus& bus) {
    run_detect_process(bus, options, [&](const RgbdFrame& frame) {
      seen = frame.camera;
      return find_nothing(frame);
    });
  });
  images_t message = frame_message(7, 0);
  for (image_t& image : message.images) {
    image.metadata.clear();
    image.nmetadata = 0;
  }
  message.images[1].row_stride = 2 * message.images[1].width;  // those drivers state it for zipped depth too
  test.bus.publish(channel::kFrame, message);
  ASSERT_TRUE(test.wait_for(channel::kDetections, 1));
  test.stop();
  EXPECT_EQ(seen, *options.camera);
  const auto status = test.last<status_t>(channel::kStatus);
  EXPECT_EQ(status.frames_processed, 1);
  EXPECT_EQ(status.frames_refused, 0);
}

TEST(DetectProcess, CamerasOfAPatternAreServedInTurnAndResultsBearTheirNames) {
  ProcessOnMemq test({channel::kDetections, channel::kStatus});
  DetectProcessOptions options;
  options.frame_channels = "LEFT|RIGHT|" + channel::kDetections;
  test.start([&](LcmBus& bus) {
    run_detect_process(bus, options, [](const RgbdFrame& frame) {
      std::this_thread::sleep_for(milliseconds(30));
      return find_nothing(frame);
    });
  });
  constexpr std::int64_t kFrames = 30;
  for (std::int64_t i = 0; i < kFrames; ++i) {
    test.bus.publish("LEFT", frame_message(1000 + i, i));
    if (i % 6 == 0) test.bus.publish("RIGHT", frame_message(1000 + i, i / 6));
    std::this_thread::sleep_for(milliseconds(10));
  }
  const std::int64_t sent = kFrames + kFrames / 6;
  const auto done = [&] { return test.count(channel::kDetections); };
  for (std::size_t before = 0; before != done(); std::this_thread::sleep_for(milliseconds(200))) before = done();
  test.stop();
  int right = 0;
  for (std::size_t i = 0; i < test.count(channel::kDetections); ++i) {
    right += test.at<detections_t>(channel::kDetections, i).source_channel == "RIGHT" ? 1 : 0;
  }
  EXPECT_GE(right, 3) << "of 5: the slow camera is not starved";
  const auto status = test.last<status_t>(channel::kStatus);
  EXPECT_EQ(status.frames_received, sent) << "its own results are no frames";
  EXPECT_EQ(status.frames_processed + status.frames_skipped, sent);
  EXPECT_GT(status.frames_skipped, 5);
  EXPECT_EQ(status.frames_lost, 0);
}

}  // namespace
}  // namespace houghstream
