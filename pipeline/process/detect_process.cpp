#include "pipeline/process/detect_process.hpp"

#include "pipeline/base/log_line.hpp"
#include "pipeline/base/stop_signal.hpp"
#include "pipeline/bus/channel_pattern.hpp"
#include "pipeline/messages/messages.hpp"
#include "pipeline/process/newest_of_each.hpp"
#include "pipeline/process/process_loop.hpp"

namespace houghstream {
namespace {

struct EncodedFrame {
  std::string channel;
  std::vector<std::uint8_t> bytes;
  std::chrono::steady_clock::time_point arrival;
};

/// How the frame follows those before it; nothing where it cannot be understood, which is counted.
std::optional<FrameOrder> order_of(const Arrival& arrival, StatusReporter& status) {
  try {
    const FrameHeader header = read_frame_header(arrival.bytes);
    return status.note_number({header.sequence, header.utime, header.run}, arrival.channel);
  } catch (const InputError& error) {
    status.count_received();
    status.count_refused(fmt::format("message on {}: {}", arrival.channel, error.what()), arrival.channel);
    return std::nullopt;
  }
}

/// `is_log`: every frame of a log is worked on, as often as it is there.
void receive_frame(const Arrival& arrival, bool is_log, StatusReporter& status, NewestOfEach<EncodedFrame>& newest) {
  const std::optional<FrameOrder> order = order_of(arrival, status);
  if (!order || (*order == FrameOrder::kDuplicate && !is_log)) return;
  status.count_received();
  const ByteView& bytes = arrival.bytes;
  EncodedFrame frame{arrival.channel, {bytes.data, bytes.data + bytes.size}, arrival.time};
  const bool passed_over = *order == FrameOrder::kLate ? newest.put_late(arrival.channel, std::move(frame))
                                                       : newest.put(arrival.channel, std::move(frame));
  if (passed_over) status.count_skipped(1);
}

RgbdFrame decode(const EncodedFrame& encoded, const std::optional<Camera>& camera) {
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
  status.tell_objects(options.objects);
  NewestOfEach<EncodedFrame> newest;
  catch_stop_signals();
  bus.subscribe(options.frame_channels, [&](const Arrival& arrival) {
    if (!channels.is_name() && !is_frame_message(arrival.bytes)) return;
    if (options.keep_frames) bus.publish(arrival.channel, arrival.bytes, arrival.event_us);
    receive_frame(arrival, bus.is_log(), status, newest);
  });
  log_info("ready: frames from {} at {}", options.frame_channels, bus.url());
  run_process_loop(bus, status, [&](std::chrono::milliseconds timeout) {
    const std::optional<EncodedFrame> encoded = newest.take(timeout);
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
