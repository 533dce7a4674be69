#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <houghstream/status_t.hpp>
#include <ostream>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/bus/event_log.hpp"
#include "pipeline/process/detect_process.hpp"
#include "pipeline/process/frame_synchroniser.hpp"
#include "pipeline/process/pose_process.hpp"
#include "tests/pipeline/process_test.hpp"
#include "tests/tools/track/one_bowl.hpp"
#include "tools/track/track_process.hpp"

// Contract of each process that works on frames, whatever its step does. The steps are fakes; their tests are beside
// the processes.

namespace houghstream {
namespace {

using Bytes = std::vector<std::uint8_t>;

struct RunOptions {
  std::string frame_channels = channel::kFrame;
  bool keep_frames = false;
};

/// A process, and what goes in and comes out of it.
struct Process {
  std::string name;
  std::string output;             ///< channel of what it publishes
  std::string input;              ///< channel of the results that it brings together with their frames; empty = of none
  std::size_t per_frame = 0;      ///< messages that it publishes for each frame
  std::size_t per_result = 0;     ///< and one for each result that has its frame
  bool passes_over_late = false;  ///< true if it drops frames overtaken by newer ones
  std::function<void(LcmBus&, const RunOptions&)> run;
};

std::ostream& operator<<(std::ostream& out, const Process& process) {
  return out << process.name;
}

ObjectPoses posed_bowl(const FrameId& frame) {
  return track::one_bowl(frame.utime, frame.channel);
}

std::string numbered_camera(std::size_t number) {
  return fmt::format("CAMERA_{}", number);
}

PoseProcessOptions pose_options(const RunOptions& run) {
  PoseProcessOptions options;
  options.frame_channels = run.frame_channels;
  options.keep_frames = run.keep_frames;
  return options;
}

void run_detect(LcmBus& bus, const RunOptions& run) {
  DetectProcessOptions options;
  options.frame_channels = run.frame_channels;
  options.keep_frames = run.keep_frames;
  run_detect_process(bus, options, [](const RgbdFrame&) { return Detections{}; });
}

void run_pose(LcmBus& bus, const RunOptions& run) {
  run_pose_process(bus, pose_options(run),
                   [](const RgbdFrame& frame, const Detections&, const ObjectPoses&) { return posed_bowl(frame.id); });
}

void run_follow(LcmBus& bus, const RunOptions& run) {
  run_follow_process(bus, pose_options(run),
                     {[](const RgbdFrame& frame) { return posed_bowl(frame.id); },
                      [](const RgbdFrame& frame, const Detections&) { return posed_bowl(frame.id); }});
}

void run_track(LcmBus& bus, const RunOptions& run) {
  track::TrackProcessOptions options;
  options.frame_channels = run.frame_channels;
  options.camera_poses[channel::kFrame] = Eigen::Isometry3d::Identity();
  for (std::size_t i = 0; i <= FrameSynchroniser::kCameras; ++i)
    options.camera_poses[numbered_camera(i)] = Eigen::Isometry3d::Identity();
  const auto models = std::make_shared<const tracks::TrackModels>();
  track::run_track_process(bus, options, [&] { return models; });
}

Process detecting() {
  Process process;
  process.name = "detect";
  process.output = channel::kDetections;
  process.per_frame = 1;
  process.run = run_detect;
  return process;
}

Process posing() {
  Process process;
  process.name = "pose";
  process.output = channel::kPoses;
  process.input = channel::kDetections;
  process.per_result = 1;
  process.run = run_pose;
  return process;
}

Process following() {
  Process process = posing();
  process.name = "follow";
  process.per_frame = 1;
  process.run = run_follow;
  return process;
}

Process tracking() {
  Process process;
  process.name = "track";
  process.output = channel::kObjects;
  process.input = channel::kPoses;
  process.per_result = 1;
  process.passes_over_late = true;
  process.run = run_track;
  return process;
}

// All are of one run of their camera, 40 ms apart.
std::int64_t utime_of(int frame) {
  return track::time_of(frame);
}

Bytes frame_bytes(int frame) {
  return encode_message(to_message(make_test_frame(utime_of(frame)), WireFormat{}, frame));
}

/// Makes a message of an input of the process, with the bowl `copies` times.
Bytes result_bytes(const Process& process, const FrameId& frame, std::size_t copies = 1) {
  if (process.input == channel::kPoses) {
    ObjectPoses poses = posed_bowl(frame);
    poses.poses.assign(copies, ObjectPose(poses.poses.at(0)));
    return encode_message(to_message(poses));
  }
  Detections detections = one_bowl(frame.utime, frame.channel);
  detections.detections.assign(copies, Detection(detections.detections.at(0)));
  return encode_message(to_message(detections));
}

/// A process on a bus of its own, and how many messages are expected of it so far.
class RunningProcess {
 public:
  explicit RunningProcess(const Process& process, const RunOptions& options = {})
      : process_(process), test_({process.output, channel::kStatus}) {
    testing::internal::CaptureStderr();
    start_log("test", LogLevel::kInfo);
    test_.start([process, options](LcmBus& bus) { process.run(bus, options); });
  }

  void publish(const std::string& name, const Bytes& bytes) {
    test_.bus.publish(name, {bytes.data(), bytes.size()}, 0);
  }

  void send_frame(int frame, const std::string& camera = channel::kFrame) { publish(camera, frame_bytes(frame)); }

  /// Does nothing where the process receives no results.
  void send_result(int frame, const std::string& camera = channel::kFrame) {
    if (joins()) publish(process_.input, result_bytes(process_, {camera, utime_of(frame)}));
  }

  /// Waits for the results of a frame, and of what was found in it.
  void expect_outputs() {
    expected_ += process_.per_frame + process_.per_result;
    EXPECT_TRUE(test_.wait_for(process_.output, expected_));
  }

  /// Sends a frame with detections, which come through.
  void send(int frame, const std::string& camera = channel::kFrame) {
    send_frame(frame, camera);
    test_.wait_for(process_.output, expected_ + process_.per_frame);
    send_result(frame, camera);
    expect_outputs();
  }

  void send_late(int frame) {
    if (!process_.passes_over_late) return send(frame);
    send_frame(frame);
    send_result(frame);
  }

  bool joins() const { return !process_.input.empty(); }
  std::size_t published() { return test_.count(process_.output); }

  /// Ends it; nothing came but what was expected, and every message is accounted for.
  void end() {
    milliseconds_to_end = test_.stop();
    log = testing::internal::GetCapturedStderr();
    status = test_.last<status_t>(channel::kStatus);
    EXPECT_EQ(published(), expected_) << log;
    EXPECT_EQ(status.frames_processed + status.frames_skipped + status.frames_refused, status.frames_received) << log;
  }

  double milliseconds_to_end = 0.0;
  std::string log;
  status_t status;

 private:
  Process process_;
  ProcessOnMemq test_;
  std::size_t expected_ = 0;
};

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

class ProcessContract : public testing::TestWithParam<Process> {};

TEST_P(ProcessContract, BadBytesAreCountedAndToldAndTheRestIsWorkedOn) {
  RunningProcess run(GetParam());
  const Bytes noise(50, 0x5A);
  run.publish(channel::kFrame, noise);
  if (run.joins()) run.publish(GetParam().input, noise);
  run.send(1);
  run.end();
  EXPECT_EQ(run.status.frames_received, 2);
  EXPECT_EQ(run.status.frames_refused, 1);
  EXPECT_TRUE(holds(run.log, "message on " + channel::kFrame)) << run.log;
  if (!run.joins()) return;
  EXPECT_TRUE(holds(run.log, "message on " + GetParam().input)) << run.log;
  EXPECT_TRUE(holds(run.log, "; 1 other bad messages")) << run.log;
}

TEST_P(ProcessContract, TooManyBytesAreRefused) {
  RunningProcess run(GetParam());
  images_t large = to_message(make_test_frame(utime_of(1)), WireFormat{}, 1);
  large.images[0].data.resize(kMaxFrameBytes);
  large.images[0].size = static_cast<std::int32_t>(kMaxFrameBytes);
  run.publish(channel::kFrame, encode_message(large));
  if (run.joins()) run.publish(GetParam().input, result_bytes(GetParam(), {channel::kFrame, utime_of(2)}, 30'000));
  run.send(2);
  run.end();
  EXPECT_EQ(run.status.frames_received, 2);
  EXPECT_EQ(run.status.frames_refused, 1);
  EXPECT_TRUE(holds(run.log, fmt::format("expected at most {}", kMaxFrameBytes))) << run.log;
  if (!run.joins()) return;
  EXPECT_TRUE(holds(run.log, "expected at most 1048576")) << run.log;
}

TEST_P(ProcessContract, WhatTheNetworkDeliversTwiceIsWorkedOnOnce) {
  RunningProcess run(GetParam());
  for (int i = 0; i < 2; ++i) run.send_frame(1);
  for (int i = 0; i < 2; ++i) run.send_result(1);
  run.expect_outputs();
  run.send(2);
  run.end();
  EXPECT_EQ(run.status.frames_received, 2);
  EXPECT_TRUE(holds(run.log, fmt::format("; {} duplicates dropped", run.joins() ? 2 : 1))) << run.log;
}

TEST_P(ProcessContract, ALateFrameIsAccountedForAndNotLost) {
  RunningProcess run(GetParam());
  run.send(0);
  run.send(2);
  run.send_late(1);
  run.send(4);
  run.end();
  EXPECT_EQ(run.status.frames_received, 4);
  EXPECT_EQ(run.status.frames_lost, 1) << "the third was overtaken, the fourth is lost";
}

TEST_P(ProcessContract, OneCameraTooManyIsRefusedWhereFramesAreKeptForEachOne) {
  RunOptions options;
  options.frame_channels = "CAMERA_.*";
  RunningProcess run(GetParam(), options);
  constexpr std::size_t kCameras = FrameSynchroniser::kCameras;
  for (std::size_t i = 0; i < kCameras; ++i) run.send(1, numbered_camera(i));
  if (run.joins()) {
    run.send_frame(1, numbered_camera(kCameras));
    run.send_result(1, numbered_camera(kCameras));
  } else {
    run.send(1, numbered_camera(kCameras));
  }
  run.send(2, numbered_camera(0));
  run.end();
  EXPECT_EQ(run.status.frames_received, static_cast<std::int64_t>(kCameras) + 2);
  EXPECT_EQ(run.status.frames_refused, run.joins() ? 1 : 0) << run.log;
}

TEST_P(ProcessContract, ItEndsWithinASecond) {
  RunningProcess run(GetParam());
  run.send(1);
  run.end();
  EXPECT_LT(run.milliseconds_to_end, 1000.0);
}

/// Processes that match results with their frames.
class JoiningProcess : public testing::TestWithParam<Process> {};

TEST_P(JoiningProcess, AnotherCamerasResultsAreLeftToOthers) {
  RunningProcess run(GetParam());
  run.send_result(1, "OTHER");
  run.send(1);
  run.end();
  EXPECT_EQ(run.status.frames_received, 1);
  EXPECT_EQ(run.status.frames_refused, 0);
}

TEST_P(JoiningProcess, AResultMayComeBeforeItsFrame) {
  RunningProcess run(GetParam());
  run.send_result(1);
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_EQ(run.published(), 0U);
  run.send_frame(1);
  run.expect_outputs();
  run.end();
}

/// A log for a process to work on, and what comes of it; removed in the end.
class LogFiles {
 public:
  explicit LogFiles(const std::vector<LogEvent>& events) {
    std::filesystem::create_directories(folder_);
    LogWriter writer(input());
    for (const LogEvent& event : events)
      writer.write(event.timestamp, event.channel, {event.data.data(), event.data.size()});
    writer.close();
  }
  ~LogFiles() { std::filesystem::remove_all(folder_); }
  LogFiles(const LogFiles&) = delete;
  LogFiles& operator=(const LogFiles&) = delete;

  std::vector<LogEvent> run(const Process& process, const RunOptions& options = {}) const {
    catch_stop_signals();
    {
      LcmBus bus("file://" + input().string(), output().string());
      process.run(bus, options);
    }
    std::vector<LogEvent> events;
    LogReader reader(output());
    while (std::optional<LogEvent> event = reader.next()) events.push_back(*std::move(event));
    return events;
  }

 private:
  std::filesystem::path input() const { return folder_ / "in.lcmlog"; }
  std::filesystem::path output() const { return folder_ / "out.lcmlog"; }

  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("process_contract_test." + std::to_string(getpid()));
};

/// Returns `count` frames, each with detections.
std::vector<LogEvent> recorded(const Process& process, int count) {
  std::vector<LogEvent> events;
  for (int i = 0; i < count; ++i) {
    events.push_back({utime_of(i), channel::kFrame, frame_bytes(i)});
    if (process.input.empty()) continue;
    events.push_back({utime_of(i), process.input, result_bytes(process, {channel::kFrame, utime_of(i)})});
  }
  return events;
}

std::vector<LogEvent> on_channel(const std::vector<LogEvent>& events, const std::string& name) {
  std::vector<LogEvent> found;
  std::copy_if(events.begin(), events.end(), std::back_inserter(found),
               [&](const LogEvent& event) { return event.channel == name; });
  return found;
}

/// Returns the bytes but for how long stages took.
Bytes without_times(const LogEvent& event) {
  if (event.channel != channel::kObjects) return event.data;
  auto message = decode_message<objects_t>({event.data.data(), event.data.size()});
  for (stage_time_t& stage : message.stages) stage.duration_us = 0;
  return encode_message(message);
}

TEST_P(ProcessContract, ALogIsWorkedOnEventByEventAndGivesTheSameBytesEachTime) {
  constexpr int kFrames = 20;
  const LogFiles log(recorded(GetParam(), kFrames));
  const std::vector<LogEvent> first = log.run(GetParam());
  const std::vector<LogEvent> second = log.run(GetParam());
  EXPECT_EQ(on_channel(first, GetParam().output).size(), kFrames * (GetParam().per_frame + GetParam().per_result));
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].channel, second[i].channel);
    EXPECT_EQ(first[i].timestamp, second[i].timestamp);
    EXPECT_EQ(without_times(first[i]), without_times(second[i])) << i;
  }
}

TEST_P(ProcessContract, OfALogEverythingIsWorkedOnAsOftenAsItIsThere) {
  std::vector<LogEvent> twice;
  for (const LogEvent& event : recorded(GetParam(), 1)) twice.insert(twice.end(), 2, event);
  const std::vector<LogEvent> results = on_channel(LogFiles(twice).run(GetParam()), GetParam().output);
  EXPECT_EQ(results.size(), 2 * (GetParam().per_frame + GetParam().per_result));
}

/// Processes that keep frames and the results that belong to them in their output log.
class KeepingProcess : public testing::TestWithParam<Process> {};

TEST_P(KeepingProcess, FramesOfALogAreKeptWhereAskedEachBeforeWhatComesOfIt) {
  const Process& process = GetParam();
  std::vector<LogEvent> events = recorded(process, 4);
  const std::vector<LogEvent> expected = events;
  events.push_back({utime_of(4), "OTHER", frame_bytes(4)});
  if (!process.input.empty())
    events.push_back({utime_of(4), process.input, result_bytes(process, {"OTHER", utime_of(4)})});
  RunOptions options;
  options.keep_frames = true;
  std::vector<LogEvent> kept = LogFiles(events).run(process, options);
  std::int64_t last_frame = 0;
  for (const LogEvent& event : kept) {
    const std::int64_t utime = read_utime({event.data.data(), event.data.size()}, "test");
    if (event.channel == channel::kFrame) last_frame = utime;
    EXPECT_EQ(utime, last_frame) << event.channel;
  }
  kept.erase(std::remove_if(kept.begin(), kept.end(),
                            [&](const LogEvent& event) {
                              return event.channel != channel::kFrame && event.channel != process.input;
                            }),
             kept.end());
  ASSERT_EQ(kept.size(), expected.size());
  for (std::size_t i = 0; i < kept.size(); ++i) {
    EXPECT_EQ(kept[i].channel, expected[i].channel);
    EXPECT_EQ(kept[i].timestamp, expected[i].timestamp);
    EXPECT_EQ(kept[i].data, expected[i].data);
  }
  LcmBus network("memq://");
  EXPECT_THROW(process.run(network, options), InputError);
}

std::string name_of(const testing::TestParamInfo<Process>& info) {
  return info.param.name;
}

INSTANTIATE_TEST_SUITE_P(Of, ProcessContract, testing::Values(detecting(), posing(), following(), tracking()), name_of);
INSTANTIATE_TEST_SUITE_P(Of, JoiningProcess, testing::Values(posing(), following(), tracking()), name_of);
INSTANTIATE_TEST_SUITE_P(Of, KeepingProcess, testing::Values(detecting(), posing(), following()), name_of);

}  // namespace
}  // namespace houghstream
