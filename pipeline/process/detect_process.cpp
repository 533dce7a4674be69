#include "pipeline/process/detect_process.hpp"

#include "pipeline/base/log_line.hpp"
#include "pipeline/base/stop_signal.hpp"
#include "pipeline/bus/channel_pattern.hpp"
#include "pipeline/messages/messages.hpp"
#include "pipeline/process/detection_throttle.hpp"
#include "pipeline/process/frame_synchroniser.hpp"
#include "pipeline/process/latest_per_channel.hpp"
#include "pipeline/process/process_loop.hpp"

namespace houghstream {
namespace {

struct WaitingFrame {
  std::string channel;
  std::vector<std::uint8_t> bytes;
  std::chrono::steady_clock::time_point arrival;
};

/// What the receiving thread does.
class Reception {
 public:
  Reception(const LcmBus& bus, StatusReporter& status, LatestPerChannel<WaitingFrame>& newest, double max_rate_hz)
      : is_log_(bus.is_log()), status_(status), newest_(newest), budget_(max_rate_hz) {}

  void receive_frame(const ReceivedMessage& arrival) {
    try {
      const FrameHeader header = read_frame_header(arrival.bytes);
      const FrameOrder order = status_.note_number({header.sequence, header.utime, header.run}, arrival.channel);
      // Every frame of a log is worked on, as often as it is there.
      if (order == FrameOrder::kDuplicate && !is_log_) return;
      status_.count_received();
      const bool passed_over = !budget_.is_due({arrival.channel, header.utime}) || put(arrival, order);
      if (passed_over) status_.count_skipped(1);
    } catch (const InputError& error) {
      status_.count_received();
      status_.count_refused(fmt::format("message on {}: {}", arrival.channel, error.what()), arrival.channel);
    }
  }

  /// Of what is followed: where something is lost, the camera is looked at soon.
  void receive_poses(const ReceivedMessage& arrival) {
    FrameSynchroniser::require_size(arrival.bytes.size);
    const ObjectPoses poses = poses_from_message(decode_message<object_poses_t>(arrival.bytes));
    for (const ObjectPose& pose : poses.poses) {
      const bool is_lost = pose.status != PoseStatus::kValid && pose.status != PoseStatus::kOccluded;
      if (pose.detection_index < 0 && is_lost) budget_.hurry(poses.frame.channel);
    }
  }

 private:
  /// Whether another frame is passed over for it, or it for another.
  bool put(const ReceivedMessage& arrival, FrameOrder order) {
    const ByteView& bytes = arrival.bytes;
    WaitingFrame frame{arrival.channel, {bytes.data, bytes.data + bytes.size}, arrival.time};
    return order == FrameOrder::kLate ? newest_.push_late(arrival.channel, std::move(frame), bytes.size)
                                      : newest_.push(arrival.channel, std::move(frame), bytes.size);
  }

  bool is_log_;
  StatusReporter& status_;
  LatestPerChannel<WaitingFrame>& newest_;
  DetectionThrottle budget_;
};

RgbdFrame decode(const WaitingFrame& encoded, const std::optional<Camera>& camera) {
  StageClock clock;
  const auto message = decode_message<images_t>({encoded.bytes.data(), encoded.bytes.size()});
  RgbdFrame frame = frame_from_message(message, encoded.channel, camera);
  clock.mark("detect.decode");
  frame.stages.push_back(clock.times().front());
  return frame;
}

}  // namespace

void run_detect_process(LcmBus& bus, const DetectProcessOptions& options,
                        const std::function<Detections(const RgbdFrame&)>& detect) {
  require(!options.keep_frames || bus.is_log(), "frames are kept of a log (-l file://LOG), not of {}", bus.url());
  const ChannelPattern channels(options.frame_channels);
  StatusReporter status(options.process);
  status.set_known_objects(options.objects);
  LatestPerChannel<WaitingFrame> newest;
  Reception reception(bus, status, newest, options.max_rate_hz);
  catch_stop_signals();
  bus.subscribe_to_frames(options.frame_channels, [&](const ReceivedMessage& arrival) {
    if (!channels.is_name() && !is_frame_message(arrival.bytes)) return;
    if (options.keep_frames) bus.publish(arrival.channel, arrival.bytes, arrival.event_us);
    reception.receive_frame(arrival);
  });
  if (options.max_rate_hz > 0.0 && !bus.is_log()) {
    bus.subscribe(channel::kPoses, [&](const ReceivedMessage& arrival) { reception.receive_poses(arrival); });
  }
  log_info("ready: frames from {} at {}", options.frame_channels, bus.url());
  run_process_loop(bus, status, [&](std::chrono::milliseconds timeout) {
    const std::optional<WaitingFrame> encoded = newest.pop(timeout);
    if (!encoded) return false;
    try {
      const RgbdFrame frame = decode(*encoded, options.camera);
      Detections detections = detect(frame);
      detections.frame = frame.id;
      bus.publish(channel::kDetections, to_message(detections));
      status.count_processed(std::chrono::steady_clock::now() - encoded->arrival);
    } catch (const std::exception& error) {
      status.count_refused(error.what(), encoded->channel + " work");
    }
    return true;
  });
  status.count_skipped(static_cast<std::int64_t>(newest.waiting()));
  end_process(bus, status);
}

}  // namespace houghstream
