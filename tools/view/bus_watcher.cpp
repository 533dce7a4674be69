#include "tools/view/bus_watcher.hpp"

#include <utility>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/base/log_throttle.hpp"
#include "pipeline/base/stop_signal.hpp"
#include "pipeline/messages/channels.hpp"
#include "pipeline/messages/messages.hpp"
#include "pipeline/messages/placed_objects_message.hpp"
#include "tools/view/preview.hpp"

namespace houghstream::view {
namespace {

std::int64_t microseconds(std::chrono::steady_clock::time_point time) {
  return std::chrono::duration_cast<std::chrono::microseconds>(time.time_since_epoch()).count();
}

}  // namespace

BusWatcher::BusWatcher(LcmBus& bus, const std::string& frame_channels, const MatchSettings& match,
                       std::size_t waiting_frames)
    : bus_(bus), reception_(bus, status_, frame_channels), matcher_(match), queue_(waiting_frames, match.kept_bytes) {
  require(!bus_.is_log(), "{}: a log is watched by replaying it with lcm-logplayer, expected a network URL",
          bus_.url());
  reception_.subscribe_to_frames(CountedAs::kReceived, [this](const ReceivedFrame& frame) { add_frame(frame); });
  subscribe_to_results();
  subscribe_to_status();
  subscribe_to_teaching();
  subscribe_to_colours();
  subscribe_to_world();
  const BlockStopSignals block;
  thread_ = std::thread([this] { listen(); });
}

BusWatcher::~BusWatcher() {
  stop();
}

void BusWatcher::stop() {
  stopping_ = true;
  if (thread_.joinable()) thread_.join();
}

void BusWatcher::add_frame(const ReceivedFrame& frame) {
  cameras_.note(frame.id.channel);
  if (!cameras_.is_shown(frame.id.channel)) {
    status_.count_skipped(1);
    return;
  }
  stream_.note_frame(microseconds(frame.time));
  matcher_.add_frame(frame.id, {frame.bytes.data, frame.bytes.data + frame.bytes.size}, microseconds(frame.time));
}

void BusWatcher::subscribe_to_results() {
  reception_.subscribe_to_results<detections_t>(
      channel::kDetections, CountedAs::kOther, [this](const ReceivedResult& result) {
        Detections detections = detections_from_message(decode_message<detections_t>(result.bytes));
        if (!cameras_.is_shown(result.id.channel)) return;
        matcher_.add_detections(std::move(detections), microseconds(result.time), result.bytes.size);
      });
  reception_.subscribe_to_messages<pose_probabilities_t>(
      channel::kPoseProbabilities,
      [this](const pose_probabilities_t& message, const ReceivedMessage& /*arrival*/) { probabilities_.add(message); });
  reception_.subscribe_to_results<object_poses_t>(
      channel::kPoses, CountedAs::kOther, [this](const ReceivedResult& result) {
        ObjectPoses poses = poses_from_message(decode_message<object_poses_t>(result.bytes));
        if (!cameras_.is_shown(result.id.channel)) return;
        probabilities_.find([&](const auto& message) { return apply_probabilities(message, poses); });
        matcher_.add_poses(std::move(poses), microseconds(result.time), result.bytes.size);
      });
}

void BusWatcher::subscribe_to_status() {
  reception_.subscribe_to_messages<status_t>(channel::kStatus,
                                             [this](const status_t& message, const ReceivedMessage& arrival) {
                                               ProcessState state;
                                               state.name = message.process;
                                               state.pid = message.pid;
                                               state.rate_hz = message.rate_hz;
                                               state.skipped = message.frames_skipped;
                                               state.lost = message.frames_lost;
                                               state.refused = message.frames_refused;
                                               state.heard_us = microseconds(arrival.time);
                                               stream_.note_process(state);
                                             });
}

void BusWatcher::subscribe_to_teaching() {
  reception_.subscribe_to_messages<teaching_t>(
      channel::kTeaching, [this](const teaching_t& message, const ReceivedMessage& arrival) {
        stream_.note_teaching(teaching_from_message(message), microseconds(arrival.time));
      });
}

void BusWatcher::subscribe_to_world() {
  reception_.subscribe_to_messages<objects_t>(
      channel::kObjects, [this](const objects_t& message, const ReceivedMessage& arrival) {
        stream_.note_world(world_from_message(message), microseconds(arrival.time));
      });
  reception_.subscribe_to_messages<placed_objects_t>(
      channel::kPlacedObjects, [this](const placed_objects_t& message, const ReceivedMessage& /*arrival*/) {
        stream_.note_placed(placed_objects_from_message(message));
      });
}

void BusWatcher::subscribe_to_colours() {
  reception_.subscribe_to_messages<camera_colours_t>(
      channel::kCameraColours, [this](const camera_colours_t& message, const ReceivedMessage& arrival) {
        stream_.note_colours(camera_colours_from_message(message), microseconds(arrival.time));
      });
}

StreamState BusWatcher::stream_state() {
  return stream_.state(microseconds(std::chrono::steady_clock::now()));
}

void BusWatcher::publish_preview(const cv::Mat& image, std::int64_t utime) {
  PreviewImage preview = encode_preview(image);
  houghstream::image_t message{};
  message.utime = utime;
  message.width = preview.width;
  message.height = preview.height;
  message.pixelformat = houghstream::image_t::PIXEL_FORMAT_MJPEG;
  message.size = static_cast<std::int32_t>(preview.jpeg.size());
  message.data = std::move(preview.jpeg);
  bus_.publish(channel::kPreview, message);
}

void BusWatcher::note_drawn(const MatchedFrame& frame) {
  const auto arrival = std::chrono::microseconds(frame.arrival_us);
  status_.count_processed(std::chrono::steady_clock::now().time_since_epoch() - arrival);
}

void BusWatcher::hand_over() {
  while (auto frame = matcher_.next(microseconds(std::chrono::steady_clock::now()))) {
    status_.count_skipped(queue_.push(std::move(*frame)));
  }
  status_.count_skipped(matcher_.passed_over() - passed_over_told_);
  passed_over_told_ = matcher_.passed_over();
}

void BusWatcher::listen() {
  constexpr std::chrono::milliseconds kTimeout(50);
  LogThrottle complaints;
  while (!stopping_) {
    try {
      bus_.handle(kTimeout);
    } catch (const std::exception& error) {
      const auto admitted = complaints.admit("bus", error.what(), std::chrono::steady_clock::now());
      if (admitted) log_error("{}", *admitted);
    }
    hand_over();
    status_.try_publish_if_due(bus_);
  }
}

}  // namespace houghstream::view
