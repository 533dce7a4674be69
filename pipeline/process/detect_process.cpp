#include "pipeline/process/detect_process.hpp"

#include "pipeline/base/log_line.hpp"
#include "pipeline/bus/channels.hpp"
#include "pipeline/messages/messages.hpp"
#include "pipeline/process/latest_slot.hpp"
#include "pipeline/process/process_loop.hpp"

namespace houghstream {
namespace {

struct EncodedFrame {
  std::vector<std::uint8_t> bytes;
  std::chrono::steady_clock::time_point arrival;
};

void receive_frame(const Arrival& arrival, StatusReporter& status, LatestSlot<EncodedFrame>& newest) {
  status.count_received();
  try {
    status.note_sequence(read_frame_header(arrival.bytes).sequence);
  } catch (const InputError& error) {
    status.count_refused(error.what());
    return;
  }
  const ByteView& bytes = arrival.bytes;
  if (newest.put({{bytes.data, bytes.data + bytes.size}, arrival.time})) status.count_skipped(1);
}

RgbdFrame decode(const EncodedFrame& encoded, const std::optional<Camera>& camera) {
  StageClock clock;
  RgbdFrame frame = frame_from_message(decode_message<images_t>({encoded.bytes.data(), encoded.bytes.size()}), camera);
  clock.mark("detect.decode");
  frame.stages.push_back(clock.times().front());
  return frame;
}

}  // namespace

void run_detect_process(LcmBus& bus, const DetectProcessOptions& options,
                        const std::function<Detections(const RgbdFrame&)>& detect) {
  StatusReporter status(options.process);
  LatestSlot<EncodedFrame> newest;
  bus.subscribe(options.frame_channel, [&](const Arrival& arrival) { receive_frame(arrival, status, newest); });
  log_info("ready: frames from {} at {}", options.frame_channel, bus.url());
  run_process_loop(bus, status, [&](std::chrono::milliseconds timeout) {
    const std::optional<EncodedFrame> encoded = newest.take(timeout);
    if (!encoded) return false;
    try {
      Detections detections = detect(decode(*encoded, options.camera));
      detections.source_channel = options.frame_channel;
      bus.publish(channel::kDetections, to_message(detections));
      status.count_processed(std::chrono::steady_clock::now() - encoded->arrival);
    } catch (const std::exception& error) {
      status.count_refused(error.what());
    }
    return true;
  });
  if (newest.take(std::chrono::milliseconds(0))) status.count_skipped(1);
  end_process(bus, status);
}

}  // namespace houghstream
