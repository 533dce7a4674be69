#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <houghstream/status_t.hpp>

#include "pipeline/base/log_line.hpp"
#include "pipeline/bus/event_log.hpp"
#include "pipeline/process/pose_process.hpp"
#include "tests/pipeline/process_test.hpp"

namespace houghstream {
namespace {

using std::chrono::milliseconds;

ObjectPoses bowl_at(const FrameId& frame, double z, int detection) {
  ObjectPose pose;
  pose.class_name = "bowl";
  pose.detection_index = detection;
  pose.status = PoseStatus::kValid;
  pose.T_camera_object = Eigen::Isometry3d(Eigen::Translation3d(0, 0, z));
  return {frame, {pose}, {}};
}

/// Follows a bowl at one metre, and finds it at two.
FollowPoses fake() {
  return {[](const RgbdFrame& frame) {
            ObjectPoses poses = bowl_at(frame.id, 1.0, -1);
            poses.stages = frame.stages;
            return poses;
          },
          [](const RgbdFrame& frame, const Detections& detections) {
            EXPECT_EQ(frame.id, detections.frame);
            return bowl_at(frame.id, 2.0, 0);
          }};
}

void run_following(LcmBus& bus) {
  run_follow_process(bus, PoseProcessOptions{}, fake());
}

images_t frame_message(std::int64_t utime) {
  return to_message(make_test_frame(utime), WireFormat{}, utime);
}

TEST(FollowProcess, EachFrameHasItsPosesWithoutDetectionsAndDetectionsTheirAnswer) {
  ProcessOnMemq test({channel::kPoses, channel::kStatus, "BOWL_TO_CAMERA"});
  test.start(run_following);
  for (std::int64_t utime = 1; utime <= 3; ++utime) {
    test.bus.publish(channel::kFrame, frame_message(utime));
    ASSERT_TRUE(test.wait_for("BOWL_TO_CAMERA", static_cast<std::size_t>(utime)));
  }
  test.bus.publish(channel::kDetections, to_message(one_bowl(2)));
  ASSERT_TRUE(test.wait_for(channel::kPoses, 4));
  test.stop();
  for (std::size_t i = 0; i < 3; ++i) {
    const ObjectPoses poses = poses_from_message(test.at<object_poses_t>(channel::kPoses, i));
    EXPECT_EQ(poses.frame, (FrameId{channel::kFrame, static_cast<std::int64_t>(i) + 1}));
    EXPECT_EQ(poses.poses.at(0).detection_index, -1);
    EXPECT_EQ(poses.stages.back().stage, "pose.decode");
  }
  const ObjectPoses answer = poses_from_message(test.at<object_poses_t>(channel::kPoses, 3));
  EXPECT_EQ(answer.frame.utime, 2);
  EXPECT_EQ(answer.poses.at(0).T_camera_object.value().translation().z(), 2.0);
  EXPECT_EQ(test.count("BOWL_TO_CAMERA"), 3U) << "transforms are of what is followed";
  const auto status = test.last<status_t>(channel::kStatus);
  EXPECT_EQ(status.frames_received, 3);
  EXPECT_EQ(status.frames_processed, 3);
}

TEST(FollowProcess, FramesDoNotWaitForAnAnswerAndAnOvertakenLookIsCounted) {
  ProcessOnMemq test({channel::kPoses, "BOWL_TO_CAMERA"});
  std::atomic<bool> may_answer{false};
  FollowPoses slow = fake();
  slow.process_detections = [&](const RgbdFrame& frame, const Detections&) {
    for (int i = 0; i < 2000 && !may_answer; ++i) std::this_thread::sleep_for(milliseconds(1));
    return bowl_at(frame.id, 2.0, 0);
  };
  test.start([&](LcmBus& bus) { run_follow_process(bus, PoseProcessOptions{}, slow); });
  test.bus.publish(channel::kFrame, frame_message(1));
  ASSERT_TRUE(test.wait_for(channel::kPoses, 1));
  test.bus.publish(channel::kDetections, to_message(one_bowl(1)));
  std::this_thread::sleep_for(milliseconds(50));
  test.bus.publish(channel::kFrame, frame_message(2));
  ASSERT_TRUE(test.wait_for(channel::kPoses, 2));
  EXPECT_EQ(test.at<object_poses_t>(channel::kPoses, 1).utime, 2);
  test.bus.publish(channel::kDetections, to_message(one_bowl(2)));
  test.bus.publish(channel::kFrame, frame_message(3));
  ASSERT_TRUE(test.wait_for(channel::kPoses, 3));
  test.bus.publish(channel::kDetections, to_message(one_bowl(3)));
  test.bus.publish(channel::kDetections, to_message(one_bowl(3, "OTHER")));  // no look at this camera
  std::this_thread::sleep_for(milliseconds(50));
  may_answer = true;
  ASSERT_TRUE(test.wait_for(channel::kPoses, 5));
  EXPECT_EQ(test.at<object_poses_t>(channel::kPoses, 3).utime, 1);
  EXPECT_EQ(test.at<object_poses_t>(channel::kPoses, 4).utime, 3);
  testing::internal::CaptureStderr();
  start_log("test", LogLevel::kInfo);
  test.stop();
  const std::string log = testing::internal::GetCapturedStderr();
  EXPECT_NE(log.find("looks: 3 came, 2 answered, 1 passed over for newer ones"), std::string::npos) << log;
}

TEST(FollowProcess, OlderFramesAreSkipped) {
  ProcessOnMemq test({channel::kPoses, channel::kStatus});
  FollowPoses slow = fake();
  slow.follow = [](const RgbdFrame& frame) {
    std::this_thread::sleep_for(milliseconds(60));
    return bowl_at(frame.id, 1.0, -1);
  };
  test.start([&](LcmBus& bus) { run_follow_process(bus, PoseProcessOptions{}, slow); });
  for (std::int64_t utime = 1; utime <= 10; ++utime) {
    test.bus.publish(channel::kFrame, frame_message(utime));
    std::this_thread::sleep_for(milliseconds(10));
  }
  for (int i = 0;
       i < 200 && (test.count(channel::kPoses) == 0 || test.last<object_poses_t>(channel::kPoses).utime != 10); ++i) {
    std::this_thread::sleep_for(milliseconds(10));
  }
  test.stop();
  EXPECT_EQ(test.last<object_poses_t>(channel::kPoses).utime, 10) << "the newest is worked on";
  const auto status = test.last<status_t>(channel::kStatus);
  EXPECT_EQ(status.frames_received, 10);
  EXPECT_GT(status.frames_skipped, 4);
  EXPECT_EQ(status.frames_processed + status.frames_skipped + status.frames_refused, status.frames_received);
}

TEST(FollowProcess, ALogIsWorkedOnInItsOrderAndStopSignalsAreCaught) {
  std::signal(SIGINT, SIG_DFL);
  const auto input = std::filesystem::temp_directory_path() / ("follow_process_in." + std::to_string(getpid()));
  const auto output = std::filesystem::temp_directory_path() / ("follow_process_out." + std::to_string(getpid()));
  LogWriter writer(input);
  const auto add = [&](const std::string& name, const auto& message) {
    const std::vector<std::uint8_t> bytes = encode_message(message);
    writer.write(message.utime, name, {bytes.data(), bytes.size()});
  };
  add(channel::kFrame, frame_message(1));
  add(channel::kFrame, frame_message(2));
  add(channel::kDetections, to_message(one_bowl(1)));
  add(channel::kFrame, frame_message(3));
  writer.close();
  {
    LcmBus bus("file://" + input.string(), output);
    run_following(bus);
  }
  std::vector<std::pair<std::int64_t, int>> poses;
  LogReader reader(output);
  while (const std::optional<LogEvent> event = reader.next()) {
    if (event->channel != channel::kPoses) continue;
    const auto message = decode_message<object_poses_t>({event->data.data(), event->data.size()});
    poses.emplace_back(message.utime, message.poses.at(0).detection_index);
  }
  EXPECT_EQ(poses, (std::vector<std::pair<std::int64_t, int>>{{1, -1}, {2, -1}, {1, 0}, {3, -1}}));
  EXPECT_NE(std::signal(SIGINT, SIG_DFL), SIG_DFL) << "Ctrl-C would cut it short";
  std::filesystem::remove(input);
  std::filesystem::remove(output);
}

}  // namespace
}  // namespace houghstream
