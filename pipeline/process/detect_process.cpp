#include "pipeline/process/detect_process.hpp"

#include "pipeline/base/log_line.hpp"
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

void receive_frame(const Arrival& arrival, StatusReporter& status, NewestOfEach<EncodedFrame>& newest) {
  status.count_received();
  try {
    status.note_sequence(read_frame_header(arrival.bytes).sequence, arrival.channel);
  } catch (const InputError& error) {
    status.count_refused(fmt::format("message on {}: {}", arrival.channel, error.what()), arrival.channel);
    return;
  }
  const ByteView& bytes = arrival.bytes;
  const bool replaced =
      newest.put(arrival.channel, {arrival.channel, {bytes.data, bytes.data + bytes.size}, arrival.time});
  if (replaced) status.count_skipped(1);
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
  bus.subscribe(options.frame_channels, [&](const Arrival& arrival) {
    if (!channels.is_name() && !is_frame_message(arrival.bytes)) return;
    if (options.keep_frames) bus.publish(arrival.channel, arrival.bytes, arrival.event_us);
    receive_frame(arrival, status, newest);
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
