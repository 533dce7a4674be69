#include "tools/view/bus_watcher.hpp"

#include <utility>
#include <vector>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/base/log_throttle.hpp"
#include "pipeline/base/stop_signal.hpp"
#include "pipeline/bus/channel_pattern.hpp"
#include "pipeline/messages/channels.hpp"
#include "pipeline/messages/messages.hpp"
#include "pipeline/process/frame_synchroniser.hpp"
#include "tools/view/preview.hpp"

namespace houghstream::view {
namespace {

std::int64_t microseconds(std::chrono::steady_clock::time_point time) {
  return std::chrono::duration_cast<std::chrono::microseconds>(time.time_since_epoch()).count();
}

}  // namespace

BusWatcher::BusWatcher(LcmBus& bus, const std::string& frame_channels, const MatchSettings& match,
                       std::size_t waiting_frames)
    : bus_(bus), matcher_(match), queue_(waiting_frames, match.kept_bytes) {
  require(!bus_.is_log(), "{}: a log is watched by replaying it with lcm-logplayer, expected a network URL",
          bus_.url());
  subscribe_to_frames(frame_channels);
  subscribe_to_results();
  subscribe_to_status();
  subscribe_to_teaching();
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

void BusWatcher::subscribe_to_frames(const std::string& frame_channels) {
  const bool is_pattern = !ChannelPattern(frame_channels).is_name();
  bus_.subscribe_to_frames(frame_channels, [this, is_pattern](const ReceivedMessage& arrival) {
    if (is_pattern && !is_frame_message(arrival.bytes)) return;
    try {
      take_frame(arrival);
    } catch (const InputError& error) {
      status_.count_received();
      status_.count_refused(fmt::format("message on {}: {}", arrival.channel, error.what()), arrival.channel);
    }
  });
}

void BusWatcher::take_frame(const ReceivedMessage& arrival) {
  const FrameHeader header = read_frame_header(arrival.bytes);
  const FrameNumber number{header.sequence, header.utime, header.run};
  if (status_.note_number(number, arrival.channel) == FrameOrder::kDuplicate) return;
  status_.count_received();
  cameras_.note(arrival.channel);
  if (!cameras_.is_shown(arrival.channel)) {
    status_.count_skipped(1);
    return;
  }
  stream_.note_frame(microseconds(arrival.time));
  std::vector<std::uint8_t> bytes(arrival.bytes.data, arrival.bytes.data + arrival.bytes.size);
  matcher_.add_frame({arrival.channel, header.utime}, std::move(bytes), microseconds(arrival.time));
}

LcmBus::Handler BusWatcher::counting_bad(LcmBus::Handler handler) {
  return [this, handler = std::move(handler)](const ReceivedMessage& arrival) {
    try {
      handler(arrival);
    } catch (const InputError& error) {
      status_.note_bad_message(fmt::format("message on {}: {}", arrival.channel, error.what()));
    }
  };
}

void BusWatcher::subscribe_to_results() {
  bus_.subscribe(channel::kDetections, counting_bad([this](const ReceivedMessage& arrival) {
                   FrameSynchroniser::require_size(arrival.bytes.size);
                   Detections detections =
                       detections_from_message(decode_message<houghstream::detections_t>(arrival.bytes));
                   if (!cameras_.is_shown(detections.frame.channel)) return;
                   matcher_.add_detections(std::move(detections), microseconds(arrival.time), arrival.bytes.size);
                 }));
  bus_.subscribe(channel::kPoses, counting_bad([this](const ReceivedMessage& arrival) {
                   FrameSynchroniser::require_size(arrival.bytes.size);
                   ObjectPoses poses = poses_from_message(decode_message<houghstream::object_poses_t>(arrival.bytes));
                   if (!cameras_.is_shown(poses.frame.channel)) return;
                   matcher_.add_poses(std::move(poses), microseconds(arrival.time), arrival.bytes.size);
                 }));
}

void BusWatcher::subscribe_to_status() {
  bus_.subscribe(channel::kStatus, counting_bad([this](const ReceivedMessage& arrival) {
                   const auto message = decode_message<houghstream::status_t>(arrival.bytes);
                   stream_.note_process({message.process, message.pid, message.rate_hz, message.frames_skipped,
                                         message.frames_lost, message.frames_refused, microseconds(arrival.time)});
                 }));
}

void BusWatcher::subscribe_to_teaching() {
  bus_.subscribe(channel::kTeaching, counting_bad([this](const ReceivedMessage& arrival) {
                   Teaching teaching = teaching_from_message(decode_message<houghstream::teaching_t>(arrival.bytes));
                   stream_.note_teaching(std::move(teaching), microseconds(arrival.time));
                 }));
}

void BusWatcher::subscribe_to_world() {
  bus_.subscribe(channel::kObjects, counting_bad([this](const ReceivedMessage& arrival) {
                   stream_.note_world(world_from_message(decode_message<houghstream::objects_t>(arrival.bytes)),
                                      microseconds(arrival.time));
                 }));
}

StreamState BusWatcher::stream_state() {
  return stream_.state(microseconds(std::chrono::steady_clock::now()));
}

void BusWatcher::publish_preview(const cv::Mat& picture, std::int64_t utime) {
  PreviewPicture preview = encode_preview(picture);
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
  constexpr std::chrono::milliseconds kPatience(50);
  LogThrottle complaints;
  while (!stopping_) {
    try {
      bus_.handle(kPatience);
    } catch (const std::exception& error) {
      const auto admitted = complaints.admit("bus", error.what(), std::chrono::steady_clock::now());
      if (admitted) log_error("{}", *admitted);
    }
    hand_over();
    status_.try_publish_if_due(bus_);
  }
}

}  // namespace houghstream::view
