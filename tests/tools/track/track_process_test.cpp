#include "tools/track/track_process.hpp"

#include <filesystem>
#include <houghstream/status_t.hpp>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/bus/event_log.hpp"
#include "tests/expect_says.hpp"
#include "tests/pipeline/process_test.hpp"
#include "tests/test_files.hpp"
#include "tests/tools/track/one_bowl.hpp"

namespace houghstream::track {
namespace {

void send_frame(ProcessOnMemq& test, int frame, const std::string& camera = channel::kFrame) {
  test.bus.publish(camera, to_message(make_test_frame(time_of(frame)), WireFormat{}, frame));
  test.bus.publish(channel::kPoses, to_message(one_bowl(time_of(frame), camera)));
}

void send_place(ProcessOnMemq& test, int frame, double x) {
  test.bus.publish(channel::to_world(channel::kFrame),
                   to_message(time_of(frame), Eigen::Isometry3d(Eigen::Translation3d(x, 0, 0))));
}

std::function<void(LcmBus&)> tracking(const TrackProcessOptions& options) {
  return [options](LcmBus& bus) {
    auto none = std::make_shared<const tracks::TrackModels>();
    run_track_process(bus, options, [&] { return none; });
  };
}

WorldObjects last_world(ProcessOnMemq& test) {
  return world_from_message(test.last<objects_t>(channel::kObjects));
}

TEST(TrackProcess, WithoutAnyPlaceTheCameraIsTheWorld) {
  ProcessOnMemq test({channel::kObjects, channel::kStatus});
  TrackProcessOptions options;
  options.wait_s = 0.02;
  test.start(tracking(options));
  for (int i = 0; i < 10; ++i) {
    send_frame(test, i);
    ASSERT_TRUE(test.wait_for(channel::kObjects, static_cast<std::size_t>(i + 1)));
  }
  const WorldObjects world = last_world(test);
  EXPECT_EQ(world.world, channel::kFrame);
  EXPECT_EQ(world.frame, (FrameId{channel::kFrame, time_of(9)}));
  ASSERT_EQ(world.objects.size(), 1U);
  EXPECT_EQ(world.objects[0].class_name, "bowl");
  EXPECT_NEAR(world.objects[0].T_world_object.translation().z(), 1.0, 1e-6);
  test.stop();
}

TEST(TrackProcess, AFrameWaitsForTheTransformAfterItAndIsPlacedBetweenTwo) {
  ProcessOnMemq test({channel::kObjects, channel::kStatus});
  TrackProcessOptions options;
  options.wait_s = 5.0;
  test.start(tracking(options));
  send_place(test, 0, 1.0);
  send_frame(test, 1);
  EXPECT_EQ(test.count(channel::kObjects), 0U);
  send_place(test, 2, 2.0);
  ASSERT_TRUE(test.wait_for(channel::kObjects, 1));
  EXPECT_EQ(last_world(test).world, "WORLD");
  EXPECT_NEAR(last_world(test).T_world_camera.translation().x(), 1.5, 1e-9);
  test.stop();
}

TEST(TrackProcess, ATransformThatDoesNotComeInTimeIsSaidAndTheFrameIsRefusedNeverPutAtTheOrigin) {
  ProcessOnMemq test({channel::kObjects, channel::kStatus});
  TrackProcessOptions options;
  options.wait_s = 0.02;
  test.start(tracking(options));
  send_place(test, 0, 1.0);
  send_frame(test, 5);
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  test.stop();
  EXPECT_EQ(test.count(channel::kObjects), 0U);
  const auto status = test.last<status_t>(channel::kStatus);
  EXPECT_EQ(status.frames_refused, 1);
  EXPECT_NE(status.last_error.find("the last transform of OPENNI_FRAME is 0.200 s older"), std::string::npos)
      << status.last_error;
}

TEST(TrackProcess, ASecondCameraWithoutAPlaceIsRefusedAndTheFirstGoesOn) {
  ProcessOnMemq test({channel::kObjects, channel::kStatus});
  TrackProcessOptions options;
  options.frame_channels = "LEFT|RIGHT";
  options.wait_s = 0.01;
  test.start(tracking(options));
  send_frame(test, 0, "LEFT");
  ASSERT_TRUE(test.wait_for(channel::kObjects, 1));
  send_frame(test, 0, "RIGHT");
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_EQ(test.count(channel::kObjects), 1U);
  send_frame(test, 1, "LEFT");
  ASSERT_TRUE(test.wait_for(channel::kObjects, 2));
  test.stop();
  EXPECT_EQ(last_world(test).frame, (FrameId{"LEFT", time_of(1)}));
  EXPECT_EQ(test.last<status_t>(channel::kStatus).frames_refused, 1);
  EXPECT_NE(test.last<status_t>(channel::kStatus).last_error.find("RIGHT_TO_WORLD"), std::string::npos);
}

TEST(TrackProcess, ForgedProcessesThatFallSilentDoNotFillTheLog) {
  ProcessOnMemq test({channel::kStatus});
  testing::internal::CaptureStderr();
  start_log("test", LogLevel::kInfo);
  test.start(tracking({}));
  status_t forged{};
  forged.process = "hs-pose";
  for (forged.pid = 1; forged.pid <= 200; ++forged.pid) {
    test.bus.publish(channel::kStatus, forged);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(3500));
  test.stop();
  const std::string log = testing::internal::GetCapturedStderr();
  int lines = 0;
  for (std::size_t at = log.find("no heartbeat"); at != std::string::npos; at = log.find("no heartbeat", at + 1))
    ++lines;
  EXPECT_GE(lines, 1) << log;
  EXPECT_LE(lines, 64) << log;
}

TEST(TrackProcess, OtherToolsAreToldOfTheObjectsWhereAsked) {
  ProcessOnMemq test({channel::kObjects, channel::kDrakeLoad, channel::kDrakeDraw, "BOWL_1_POSE"});
  TrackProcessOptions options;
  options.wait_s = 0.02;
  options.output.drake_meshes = std::filesystem::temp_directory_path() / "houghstream_track_process_meshes";
  options.output.pose_channels = true;
  test.start(tracking(options));
  for (int i = 0; i < 10; ++i) {
    send_frame(test, i);
    ASSERT_TRUE(test.wait_for(channel::kObjects, static_cast<std::size_t>(i + 1)));
  }
  test.stop();
  ASSERT_EQ(last_world(test).objects.size(), 1U);
  ASSERT_GE(test.count("BOWL_1_POSE"), 5U);
  const auto pose = test.only_sent<pose_t>("BOWL_1_POSE", test.count("BOWL_1_POSE") - 1);
  EXPECT_EQ(pose.utime, time_of(9));
  EXPECT_NEAR(pose.pos[2], 1.0, 1e-6);
  EXPECT_NEAR(pose.orientation[0], 1.0, 1e-6);
  ASSERT_EQ(test.count(channel::kDrakeLoad), 2U) << "the empty world, and the one with a bowl";
  EXPECT_EQ(test.only_sent<drake_viewer_load_robot_t>(channel::kDrakeLoad, 0).num_links, 0);
  const auto load = test.only_sent<drake_viewer_load_robot_t>(channel::kDrakeLoad, 1);
  ASSERT_EQ(load.num_links, 1);
  EXPECT_EQ(load.link[0].name, "bowl_1");
  ASSERT_EQ(test.count(channel::kDrakeDraw), 10U);
  const auto draw = test.only_sent<drake_viewer_draw_t>(channel::kDrakeDraw, 9);
  EXPECT_EQ(draw.timestamp, time_of(9) / 1000);
  ASSERT_EQ(draw.link_name, std::vector<std::string>{"bowl_1"});
  EXPECT_NEAR(draw.position[0][2], 1.0F, 1e-6F);
}

TEST(TrackProcess, OtherToolsAreToldNothingUnasked) {
  ProcessOnMemq test({channel::kObjects, channel::kDrakeLoad, channel::kDrakeDraw, "BOWL_1_POSE"});
  TrackProcessOptions options;
  options.wait_s = 0.02;
  test.start(tracking(options));
  for (int i = 0; i < 5; ++i) {
    send_frame(test, i);
    ASSERT_TRUE(test.wait_for(channel::kObjects, static_cast<std::size_t>(i + 1)));
  }
  test.stop();
  EXPECT_EQ(test.count("BOWL_1_POSE") + test.count(channel::kDrakeLoad) + test.count(channel::kDrakeDraw), 0U);
}

TEST(TrackProcess, ALogGivesTheSameObjectsEachTime) {
  catch_stop_signals();
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "houghstream_track_process";
  std::filesystem::create_directories(folder);
  LogWriter writer(folder / "in.lcmlog");
  const auto write = [&](const std::string& name, std::int64_t utime, const auto& message) {
    const std::vector<std::uint8_t> bytes = encode_message(message);
    writer.write(utime, name, {bytes.data(), bytes.size()});
  };
  for (int i = 0; i < 20; ++i) {
    write(channel::to_world(channel::kFrame), time_of(i),
          to_message(time_of(i), Eigen::Isometry3d(Eigen::Translation3d(0.01 * i, 0, 0))));
    write(channel::kFrame, time_of(i), to_message(make_test_frame(time_of(i)), WireFormat{}, i));
    write(channel::kPoses, time_of(i), to_message(one_bowl(time_of(i))));
  }
  writer.close();
  std::vector<std::vector<WorldObjects>> runs;
  for (const char* name : {"first.lcmlog", "second.lcmlog"}) {
    LcmBus bus("file://" + (folder / "in.lcmlog").string(), (folder / name).string());
    auto none = std::make_shared<const tracks::TrackModels>();
    run_track_process(bus, {}, [&] { return none; });
    runs.emplace_back();
    LogReader reader(folder / name);
    while (const std::optional<LogEvent> event = reader.next())
      runs.back().push_back(world_from_message(decode_message<objects_t>({event->data.data(), event->data.size()})));
  }
  ASSERT_EQ(runs[0].size(), 20U);
  ASSERT_EQ(runs[1].size(), 20U);
  for (std::size_t i = 0; i < 20; ++i) {
    ASSERT_EQ(runs[0][i].objects.size(), runs[1][i].objects.size());
    for (std::size_t k = 0; k < runs[0][i].objects.size(); ++k) {
      EXPECT_EQ(runs[0][i].objects[k].T_world_object.matrix(), runs[1][i].objects[k].T_world_object.matrix());
      EXPECT_EQ(runs[0][i].objects[k].probability, runs[1][i].objects[k].probability);
    }
  }
}

TEST(TrackProcess, AResultThatComesTwoSecondsLateIsPassedOverAndTheWorldGoesOn) {
  catch_stop_signals();
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "houghstream_track_late";
  std::filesystem::create_directories(folder);
  constexpr int kFrames = 61;
  constexpr int kLate = 5;
  LogWriter writer(folder / "in.lcmlog");
  const auto write = [&](const std::string& name, std::int64_t utime, const auto& message) {
    const std::vector<std::uint8_t> bytes = encode_message(message);
    writer.write(utime, name, {bytes.data(), bytes.size()});
  };
  for (int i = 0; i < kFrames; ++i) {
    if (i + 1 == kFrames) write(channel::kPoses, time_of(i - 1), to_message(one_bowl(time_of(kLate))));
    write(channel::kFrame, time_of(i), to_message(make_test_frame(time_of(i)), WireFormat{}, i));
    if (i != kLate) write(channel::kPoses, time_of(i), to_message(one_bowl(time_of(i))));
  }
  writer.close();
  {
    LcmBus bus("file://" + (folder / "in.lcmlog").string(), (folder / "out.lcmlog").string());
    auto none = std::make_shared<const tracks::TrackModels>();
    run_track_process(bus, {}, [&] { return none; });
  }
  int worlds = 0;
  LogReader reader(folder / "out.lcmlog");
  while (const std::optional<LogEvent> event = reader.next()) {
    const auto world = world_from_message(decode_message<objects_t>({event->data.data(), event->data.size()}));
    EXPECT_EQ(world.world_number, 1) << to_string(world.frame);
    ++worlds;
  }
  EXPECT_EQ(worlds, kFrames - 1);
}

TEST(TrackProcess, ALogWithoutPosesIsRefused) {
  catch_stop_signals();
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "houghstream_track_no_poses.lcmlog";
  LogWriter writer(file);
  const std::vector<std::uint8_t> bytes = encode_message(to_message(make_test_frame(1), WireFormat{}, 0));
  writer.write(1, channel::kFrame, {bytes.data(), bytes.size()});
  writer.close();
  LcmBus bus("file://" + file.string());
  auto none = std::make_shared<const tracks::TrackModels>();
  EXPECT_THROW(run_track_process(bus, {}, [&] { return none; }), InputError);
}

TEST(TrackProcess, ALogOfPosesWithoutTheirFramesIsRefusedWithWhatKeepsThem) {
  catch_stop_signals();
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "houghstream_track_no_frames.lcmlog";
  LogWriter writer(file);
  for (int i = 0; i < 3; ++i) {
    const std::vector<std::uint8_t> bytes = encode_message(to_message(one_bowl(time_of(i))));
    writer.write(time_of(i), channel::kPoses, {bytes.data(), bytes.size()});
  }
  writer.close();
  LcmBus bus("file://" + file.string());
  auto none = std::make_shared<const tracks::TrackModels>();
  expect_says(error_of([&] { run_track_process(bus, {}, [&] { return none; }); }),
              {"3 object_poses_t and the frames of none", "hs-pose --keep-frames"});
}

}  // namespace
}  // namespace houghstream::track
