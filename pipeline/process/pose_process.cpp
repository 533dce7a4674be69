#include "pipeline/process/pose_process.hpp"

#include "pipeline/base/log_line.hpp"
#include "pipeline/bus/channels.hpp"
#include "pipeline/messages/messages.hpp"
#include "pipeline/process/pair_inbox.hpp"
#include "pipeline/process/process_loop.hpp"

namespace houghstream {
namespace {

using Estimate = std::function<ObjectPoses(const RgbdFrame&, const Detections&)>;

std::vector<std::uint8_t> copy(ByteView bytes) {
  return {bytes.data, bytes.data + bytes.size};
}

ByteView view(const std::vector<std::uint8_t>& bytes) {
  return {bytes.data(), bytes.size()};
}

void receive_frame(const Arrival& arrival, StatusReporter& status, PairInbox& inbox) {
  try {
    const FrameHeader header = read_frame_header(arrival.bytes);
    status.note_sequence(header.sequence);
    inbox.put_frame(header.utime, copy(arrival.bytes));
  } catch (const InputError& error) {
    status.note_error(error.what());
  }
}

void receive_detections(const Arrival& arrival, StatusReporter& status, PairInbox& inbox) {
  status.count_received();
  try {
    check_wire(arrival.bytes, detections_t::getHash(), detections_t::getTypeName());
    inbox.put_detections(read_utime(arrival.bytes, arrival.channel), copy(arrival.bytes));
  } catch (const InputError& error) {
    status.count_refused(error.what());
  }
}

/// A frame, and how long it took to decode.
struct DecodedFrame {
  RgbdFrame frame;
  StageTime decoding;
};

DecodedFrame decode(const std::vector<std::uint8_t>& bytes, const std::optional<Camera>& camera) {
  StageClock clock;
  RgbdFrame frame = frame_from_message(decode_message<images_t>(view(bytes)), camera);
  clock.mark("pose.decode");
  return {std::move(frame), clock.times().front()};
}

/// The newest frame, decoded while its detections are on the way. What cannot be understood is told when they come.
std::optional<DecodedFrame> decode_ahead(PairInbox& inbox, const std::optional<Camera>& camera) {
  const std::optional<ArrivedFrame> fresh = inbox.take_fresh();
  if (!fresh) return std::nullopt;
  try {
    return decode(fresh->bytes, camera);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

ObjectPoses estimate_pair(const FramePair& pair, const std::optional<DecodedFrame>& ahead,
                          const std::optional<Camera>& camera, const Estimate& estimate) {
  Detections detections = detections_from_message(decode_message<detections_t>(view(pair.detections)));
  if (detections.detections.empty()) return {detections.utime, detections.source_channel, {}, detections.stages};
  const bool is_ahead = ahead && ahead->frame.utime == detections.utime;
  const DecodedFrame decoded = is_ahead ? *ahead : decode(pair.frame, camera);
  detections.stages.push_back(decoded.decoding);
  ObjectPoses poses = estimate(decoded.frame, detections);
  poses.source_channel = detections.source_channel;
  return poses;
}

void publish(LcmBus& bus, const ObjectPoses& poses) {
  bus.publish(channel::kPoses, to_message(poses));
  for (const ObjectPose& pose : poses.poses) {
    if (!pose.T_camera_object) continue;
    bus.publish(channel::to_camera(pose.class_name), to_message(poses.utime, *pose.T_camera_object));
  }
}

void count_dropped(PairInbox& inbox, StatusReporter& status) {
  const PairInbox::Dropped dropped = inbox.take_dropped();
  status.count_skipped(dropped.skipped);
  for (const std::int64_t utime : dropped.without_frame) {
    status.count_refused(fmt::format("detections of frame {}: the frame itself has not come", utime));
  }
}

}  // namespace

void run_pose_process(LcmBus& bus, const PoseProcessOptions& options, const Estimate& estimate) {
  StatusReporter status(options.process);
  PairInbox inbox(!bus.is_log());
  bus.subscribe(options.frame_channel, [&](const Arrival& arrival) { receive_frame(arrival, status, inbox); });
  bus.subscribe(channel::kDetections, [&](const Arrival& arrival) { receive_detections(arrival, status, inbox); });
  log_info("ready: frames from {}, detections from {} at {}", options.frame_channel, channel::kDetections, bus.url());
  std::optional<DecodedFrame> ahead;
  run_process_loop(bus, status, [&](std::chrono::milliseconds timeout) {
    const std::optional<FramePair> pair = inbox.take(timeout);
    count_dropped(inbox, status);
    if (!pair) {
      if (std::optional<DecodedFrame> newer = decode_ahead(inbox, options.camera)) ahead = std::move(newer);
      return false;
    }
    try {
      publish(bus, estimate_pair(*pair, ahead, options.camera, estimate));
      status.count_processed(std::chrono::steady_clock::now() - pair->arrival);
    } catch (const std::exception& error) {
      status.count_refused(error.what());
    }
    return true;
  });
  inbox.give_up_waiting();
  count_dropped(inbox, status);
  end_process(bus, status);
}

}  // namespace houghstream
