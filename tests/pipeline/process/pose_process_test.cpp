#include "pipeline/process/pose_process.hpp"

#include <unistd.h>

#include <filesystem>
#include <houghstream/status_t.hpp>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/bus/event_log.hpp"
#include "tests/pipeline/process_test.hpp"

namespace houghstream {
namespace {

using std::chrono::milliseconds;

ObjectPoses at_one_metre(const RgbdFrame& frame, const Detections& detections, const ObjectPoses&) {
  EXPECT_EQ(frame.id, detections.frame);
  ObjectPose pose;
  pose.class_name = detections.detections.at(0).class_name;
  pose.detection_index = 0;
  pose.status = PoseStatus::kValid;
  pose.T_camera_object = Eigen::Isometry3d(Eigen::Translation3d(0, 0, 1));
  ObjectPoses poses;
  poses.frame = detections.frame;
  poses.poses = {pose};
  poses.stages = detections.stages;
  return poses;
}

void send_frame(ProcessOnMemq& test, std::int64_t utime, const std::string& camera = channel::kFrame) {
  test.bus.publish(camera, to_message(make_test_frame(utime), WireFormat{}, utime));
}

void run_fake(LcmBus& bus) {
  run_pose_process(bus, PoseProcessOptions{}, at_one_metre);
}

TEST(PoseProcess, PublishesPosesAndTransforms) {
  ProcessOnMemq test({channel::kPoses, channel::kStatus, "BOWL_TO_CAMERA"});
  test.start(run_fake);
  send_frame(test, 10);
  test.bus.publish(channel::kDetections, to_message(one_bowl(10)));
  ASSERT_TRUE(test.wait_for("BOWL_TO_CAMERA", 1));
  const ObjectPoses poses = poses_from_message(test.at<object_poses_t>(channel::kPoses, 0));
  EXPECT_EQ(poses.frame, (FrameId{channel::kFrame, 10}));
  ASSERT_EQ(poses.poses.size(), 1U);
  EXPECT_EQ(poses.stages.at(0).stage, "pose.decode");
  EXPECT_EQ(test.at<rigid_transform_t>("BOWL_TO_CAMERA", 0).trans[2], 1.0);
  test.stop();
}

TEST(PoseProcess, FramesThatAreNamedOnAnObjectHaveTransformsToo) {
  ProcessOnMemq test({"BOWL_TO_CAMERA", "BOWL_RIM_TO_CAMERA", "CAN_LID_TO_CAMERA"});
  PoseProcessOptions options;
  options.frames = [] {
    const Eigen::Isometry3d above(Eigen::Translation3d(0, 0.25, 0));
    return NamedFrames{{"bowl", {{"rim", above}}}, {"can", {{"lid", above}}}};
  };
  test.start([&](LcmBus& bus) { run_pose_process(bus, options, at_one_metre); });
  send_frame(test, 10);
  test.bus.publish(channel::kDetections, to_message(one_bowl(10)));
  ASSERT_TRUE(test.wait_for("BOWL_RIM_TO_CAMERA", 1));
  const auto rim = test.at<rigid_transform_t>("BOWL_RIM_TO_CAMERA", 0);
  EXPECT_EQ(rim.utime, 10);
  EXPECT_EQ(rim.trans[1], 0.25);
  EXPECT_EQ(rim.trans[2], 1.0);
  EXPECT_EQ(test.count("CAN_LID_TO_CAMERA"), 0U);
  test.stop();
}

TEST(PoseProcess, WhatIsLearntOfACameraIsToldOnceASecond) {
  ProcessOnMemq test({channel::kPoses, channel::kCameraColours, channel::kCameraTiming});
  PoseProcessOptions options;
  options.camera_colours = [](const std::string& camera) {
    ChromaPair pair;
    pair.class_name = "bowl";
    pair.probability = 0.9;
    return CameraChroma{{camera, 10}, {pair}};
  };
  options.camera_timing = [](const std::string& camera) { return CameraTiming{{camera, 10}, -0.011, 0.001}; };
  test.start([&](LcmBus& bus) { run_pose_process(bus, options, at_one_metre); });
  std::size_t answered = 0;
  for (const std::int64_t utime : {10, 500'000, 1'200'000}) {
    send_frame(test, utime);
    test.bus.publish(channel::kDetections, to_message(one_bowl(utime)));
    ASSERT_TRUE(test.wait_for(channel::kPoses, ++answered));
  }
  ASSERT_TRUE(test.wait_for(channel::kCameraColours, 2));
  ASSERT_TRUE(test.wait_for(channel::kCameraTiming, 2));
  test.stop();
  EXPECT_EQ(test.count(channel::kCameraColours), 2U);
  const CameraChroma told = camera_colours_from_message(test.at<camera_colours_t>(channel::kCameraColours, 0));
  EXPECT_EQ(told.frame.channel, channel::kFrame);
  EXPECT_EQ(told.objects.at(0).class_name, "bowl");
  EXPECT_EQ(test.count(channel::kCameraTiming), 2U);
  const CameraTiming timing = camera_timing_from_message(test.at<camera_timing_t>(channel::kCameraTiming, 0));
  EXPECT_EQ(timing.frame.channel, channel::kFrame);
  EXPECT_FLOAT_EQ(timing.depth_lag_s, -0.011F);
}

TEST(PoseProcess, EmptyDetectionsGiveEmptyPosesWithoutDecoding) {
  ProcessOnMemq test({channel::kPoses, channel::kStatus});
  test.start(run_fake);
  images_t undecodable = to_message(make_test_frame(11), WireFormat{}, 0);
  undecodable.images[0].data.assign(10, 0);
  undecodable.images[0].size = 10;
  test.bus.publish(channel::kFrame, undecodable);
  Detections none = one_bowl(11);
  none.detections.clear();
  test.bus.publish(channel::kDetections, to_message(none));
  ASSERT_TRUE(test.wait_for(channel::kPoses, 1));
  EXPECT_EQ(test.at<object_poses_t>(channel::kPoses, 0).n_poses, 0);
  test.stop();
}

TEST(PoseProcess, DetectionsOfAFrameThatIsNotThereAreCountedAndDropped) {
  ProcessOnMemq test({channel::kPoses, channel::kStatus});
  test.start(run_fake);
  send_frame(test, 1);
  test.bus.publish(channel::kDetections, to_message(one_bowl(2)));
  std::this_thread::sleep_for(milliseconds(300));
  test.stop();
  EXPECT_EQ(test.count(channel::kPoses), 0U);
  const auto status = test.last<status_t>(channel::kStatus);
  EXPECT_EQ(status.frames_received, 1);
  EXPECT_EQ(status.frames_refused, 1);
  EXPECT_EQ(status.frames_processed, 0);
  EXPECT_NE(status.last_error.find("frame OPENNI_FRAME 2"), std::string::npos) << status.last_error;
}

/// Poses that tell which image they were computed on: the depth of its first pixel with one.
ObjectPoses by_image(const RgbdFrame& frame, const Detections& detections, const ObjectPoses& earlier) {
  ObjectPoses poses = at_one_metre(frame, detections, earlier);
  const double depth = static_cast<double>(frame.depth.at<float>(0, 1));
  poses.poses[0].T_camera_object = Eigen::Isometry3d(Eigen::Translation3d(0, 0, depth));
  return poses;
}

images_t image(std::int64_t utime, float depth) {
  RgbdFrame frame = make_test_frame(utime);
  frame.depth.setTo(depth);
  return to_message(frame, WireFormat{}, utime);
}

TEST(PoseProcess, TwoCamerasOfEqualTimesGetPosesOfTheirOwnImages) {
  ProcessOnMemq test({channel::kPoses, "BOWL_TO_LEFT", "BOWL_TO_RIGHT", "BOWL_TO_CAMERA"});
  PoseProcessOptions options;
  options.frame_channels = "LEFT|RIGHT";
  test.start([&](LcmBus& bus) { run_pose_process(bus, options, by_image); });
  constexpr std::size_t kFrames = 5;
  for (std::size_t i = 1; i <= kFrames; ++i) {
    const auto utime = static_cast<std::int64_t>(i);
    test.bus.publish("LEFT", image(utime, 1.0F));
    test.bus.publish("RIGHT", image(utime, 2.0F));
    test.bus.publish(channel::kDetections, to_message(one_bowl(utime, "RIGHT")));
    test.bus.publish(channel::kDetections, to_message(one_bowl(utime, "LEFT")));
    ASSERT_TRUE(test.wait_for(channel::kPoses, 2 * i));
  }
  ASSERT_TRUE(test.wait_for("BOWL_TO_LEFT", kFrames));
  ASSERT_TRUE(test.wait_for("BOWL_TO_RIGHT", kFrames));
  test.stop();
  for (std::size_t i = 0; i < kFrames; ++i) {
    EXPECT_EQ(test.at<rigid_transform_t>("BOWL_TO_LEFT", i).trans[2], 1.0);
    EXPECT_EQ(test.at<rigid_transform_t>("BOWL_TO_RIGHT", i).trans[2], 2.0);
  }
  EXPECT_EQ(test.count("BOWL_TO_CAMERA"), 0U);
}

TEST(PoseProcess, TwoDetectorsOfOneCameraBothGetTheirPoses) {
  ProcessOnMemq test({channel::kPoses, channel::kStatus, "BOWL_TO_CAMERA", "CAN_TO_CAMERA"});
  test.start(run_fake);
  Detections cans = one_bowl(3);
  cans.detections[0].class_name = "can";
  send_frame(test, 3);
  test.bus.publish(channel::kDetections, to_message(one_bowl(3)));
  test.bus.publish(channel::kDetections, to_message(cans));
  EXPECT_TRUE(test.wait_for("BOWL_TO_CAMERA", 1));
  EXPECT_TRUE(test.wait_for("CAN_TO_CAMERA", 1));
  test.stop();
  EXPECT_EQ(test.last<status_t>(channel::kStatus).frames_processed, 2);
}

TEST(PoseProcess, OtherCamerasDetectionsAreLeftToOthersAndTransformsThenNameTheCamera) {
  ProcessOnMemq test({channel::kPoses, channel::kStatus, "BOWL_TO_CAMERA", "BOWL_TO_OPENNI_FRAME"});
  test.start(run_fake);
  send_frame(test, 1);
  test.bus.publish(channel::kDetections, to_message(one_bowl(1)));
  ASSERT_TRUE(test.wait_for("BOWL_TO_CAMERA", 1));
  test.bus.publish(channel::kDetections, to_message(one_bowl(1, "RIGHT")));
  send_frame(test, 2);
  test.bus.publish(channel::kDetections, to_message(one_bowl(2)));
  ASSERT_TRUE(test.wait_for("BOWL_TO_OPENNI_FRAME", 1));
  test.stop();
  EXPECT_EQ(test.count("BOWL_TO_CAMERA"), 1U);
  const auto status = test.last<status_t>(channel::kStatus);
  EXPECT_EQ(status.frames_received, 2);
  EXPECT_EQ(status.frames_refused, 0);
}

TEST(PoseProcess, PosesStartFromTheCamerasOwnLastOnes) {
  ProcessOnMemq test({channel::kPoses});
  PoseProcessOptions options;
  options.frame_channels = "LEFT|RIGHT";
  std::vector<FrameId> earlier_frames;
  test.start([&](LcmBus& bus) {
    run_pose_process(bus, options,
                     [&](const RgbdFrame& frame, const Detections& detections, const ObjectPoses& earlier) {
                       earlier_frames.push_back(earlier.frame);
                       return at_one_metre(frame, detections, earlier);
                     });
  });
  std::size_t sent = 0;
  for (const std::int64_t utime : {1, 2}) {
    for (const std::string camera : {"LEFT", "RIGHT"}) {
      send_frame(test, utime, camera);
      test.bus.publish(channel::kDetections, to_message(one_bowl(utime, camera)));
      ASSERT_TRUE(test.wait_for(channel::kPoses, ++sent));
    }
  }
  test.stop();
  EXPECT_EQ(earlier_frames, (std::vector<FrameId>{{"", 0}, {"", 0}, {"LEFT", 1}, {"RIGHT", 1}}));
}

/// Writes a log of detections of four frames, and of the first `frames` of these, and removes it at the end.
class ResultLog {
 public:
  explicit ResultLog(int frames)
      : path(std::filesystem::temp_directory_path() / ("pose_process_test." + std::to_string(getpid()))) {
    LogWriter writer(path);
    const auto add = [&](const std::string& name, const auto& message) {
      const std::vector<std::uint8_t> bytes = encode_message(message);
      writer.write(message.utime, name, {bytes.data(), bytes.size()});
    };
    for (int i = 0; i < 4; ++i) {
      if (i < frames) add(channel::kFrame, to_message(make_test_frame(i), WireFormat{}, i));
      add(channel::kDetections, to_message(one_bowl(i)));
    }
    writer.close();
  }
  ~ResultLog() {
    std::filesystem::remove(path);
    std::filesystem::remove(out());
  }
  ResultLog(const ResultLog&) = delete;
  ResultLog& operator=(const ResultLog&) = delete;

  std::string out() const { return path.string() + ".out"; }

  /// Runs hs-pose on the log and returns its log.
  std::string run() const {
    catch_stop_signals();
    testing::internal::CaptureStderr();
    start_log("test", LogLevel::kInfo);
    LcmBus bus("file://" + path.string(), out());
    run_fake(bus);
    return testing::internal::GetCapturedStderr();
  }

  std::filesystem::path path;
};

TEST(PoseProcess, ALogWithoutFramesFailsAndOneWithoutSomeSaysHowMany) {
  const ResultLog none(0);
  try {
    none.run();
    ADD_FAILURE() << "expected an error";
  } catch (const InputError& error) {
    testing::internal::GetCapturedStderr();
    EXPECT_NE(std::string(error.what()).find("4 of 4 detections_t had no frame"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("--keep-frames"), std::string::npos) << error.what();
  }
  EXPECT_NE(ResultLog(3).run().find("1 of 4 detections_t had no frame"), std::string::npos);
  EXPECT_EQ(ResultLog(4).run().find("had no frame"), std::string::npos);
}

TEST(PoseProcess, ModelsOfOtherObjectsThanTheDetectorsAreToldOnce) {
  ProcessOnMemq test({channel::kPoses});
  PoseProcessOptions options;
  options.models = {"mug"};
  testing::internal::CaptureStderr();
  start_log("test", LogLevel::kInfo);
  test.start([&](LcmBus& bus) { run_pose_process(bus, options, at_one_metre); });
  send_frame(test, 1);
  test.bus.publish(channel::kDetections, to_message(one_bowl(1)));
  ASSERT_TRUE(test.wait_for(channel::kPoses, 1));
  test.stop();
  const std::string log = testing::internal::GetCapturedStderr();
  EXPECT_NE(log.find("detected are bowl; there are models of mug"), std::string::npos) << log;
}

TEST(PoseProcess, TwoRunsOfACameraWithEqualStampsAreNotTwoDetectors) {
  ProcessOnMemq test({channel::kPoses, channel::kStatus});
  test.start(run_fake);
  std::size_t sent = 0;
  for (std::int64_t run = 1; run <= 3; ++run) {
    for (std::int64_t utime = 10; utime < 14; ++utime) {
      images_t frame = to_message(make_test_frame(utime), WireFormat{}, utime);
      add_run(frame, run);
      test.bus.publish(channel::kFrame, frame);
      Detections detections = one_bowl(utime);
      detections.detections[0].score = 0.1F * static_cast<float>(run);
      test.bus.publish(channel::kDetections, to_message(detections));
      ASSERT_TRUE(test.wait_for(channel::kPoses, ++sent)) << run << " " << utime;
    }
  }
  test.stop();
  const auto status = test.last<status_t>(channel::kStatus);
  EXPECT_EQ(status.last_error, "");
  EXPECT_EQ(status.frames_processed, 12);
}

TEST(PoseProcess, TwoDetectorsOfOneObjectAreTold) {
  ProcessOnMemq test({channel::kPoses, channel::kStatus});
  test.start(run_fake);
  send_frame(test, 10);
  test.bus.publish(channel::kDetections, to_message(one_bowl(10)));
  Detections other = one_bowl(10);
  other.detections[0].score = 0.5F;
  test.bus.publish(channel::kDetections, to_message(other));
  ASSERT_TRUE(test.wait_for(channel::kPoses, 2));
  test.stop();
  const std::string error = test.last<status_t>(channel::kStatus).last_error;
  EXPECT_NE(error.find("two detectors find 'bowl'"), std::string::npos) << error;
}

}  // namespace
}  // namespace houghstream
