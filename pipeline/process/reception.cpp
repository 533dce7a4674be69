#include "pipeline/process/reception.hpp"

#include <fmt/format.h>

#include "pipeline/base/checks.hpp"
#include "pipeline/types/frame_time.hpp"

namespace houghstream {

SharedBytes shared_copy(ByteView bytes) {
  return std::make_shared<const std::vector<std::uint8_t>>(bytes.data, bytes.data + bytes.size);
}

Reception::Reception(LcmBus& bus, StatusReporter& status, const std::string& frame_channels, bool keep_frames)
    : bus_(bus), status_(status), pattern_(frame_channels), keep_frames_(keep_frames) {
  require(!keep_frames || bus.is_log(), "frames are kept of a log (-l file://LOG), not of {}", bus.url());
}

void Reception::subscribe_to_frames(CountedAs counted_as, FrameHandler handler) {
  bus_.subscribe_to_frames(pattern_.text(), [=, handler = std::move(handler)](const ReceivedMessage& message) {
    if (!pattern_.is_name() && !is_frame_message(message.bytes)) return;
    if (keep_frames_) bus_.publish(message.channel, message.bytes, message.event_us);
    receive(message, counted_as, [&] { return handle_frame(message, handler); });
  });
}

bool Reception::handle_frame(const ReceivedMessage& message, const FrameHandler& handler) {
  const FrameHeader header = read_frame_header(message.bytes);
  const FrameOrder order = status_.note_number({header.sequence, header.utime, header.run}, message.channel);
  if (order == FrameOrder::kDuplicate && !bus_.is_log()) return false;
  handler({{message.channel, header.utime}, order, message.bytes, message.time});
  return true;
}

void Reception::subscribe_to_results(MessageType type, const std::string& channel, CountedAs counted_as,
                                     ResultHandlers handlers) {
  const auto duplicates = std::make_shared<DuplicateFilter>();
  bus_.subscribe(channel, [=, type = std::move(type), handlers = std::move(handlers)](const ReceivedMessage& message) {
    receive(message, counted_as, [&] {
      require(message.bytes.size <= kMaxResultBytes, "results of {} bytes, expected at most {}", message.bytes.size,
              kMaxResultBytes);
      check_wire(message.bytes, type.fingerprint, type.name);
      return handle_result(message, handlers, *duplicates);
    });
  });
}

bool Reception::handle_result(const ReceivedMessage& message, const ResultHandlers& handlers,
                              DuplicateFilter& duplicates) {
  const FrameId frame = read_result_frame(message.bytes, message.channel);
  if (!bus_.is_log() && duplicates.is_duplicate(frame, message.bytes.data, message.bytes.size, message.time)) {
    status_.note_duplicate();
    return false;
  }
  if (!pattern_.matches(frame.channel)) {
    if (handlers.other_camera) handlers.other_camera(frame);
    return false;
  }
  if (keep_frames_) bus_.publish(message.channel, message.bytes, message.event_us);
  handlers.handler({frame, message.bytes, message.time});
  return true;
}

void Reception::receive(const ReceivedMessage& message, CountedAs counted_as, const std::function<bool()>& handle) {
  advance_log_clock(message);
  try {
    if (handle() && counted_as == CountedAs::kReceived) status_.count_received();
  } catch (const InputError& error) {
    const std::string reason = fmt::format("message on {}: {}", message.channel, error.what());
    if (counted_as == CountedAs::kOther) return status_.note_bad_message(reason);
    status_.count_received();
    status_.count_refused(reason, message.channel);
  }
}

std::int64_t Reception::now_us() const {
  if (bus_.is_log()) return log_clock_us_;
  return std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

void Reception::advance_log_clock(const ReceivedMessage& message) {
  if (!bus_.is_log()) return;
  if (event_us_ && message.event_us > *event_us_)
    log_clock_us_ = shifted(log_clock_us_, microseconds_between(*event_us_, message.event_us));
  event_us_ = message.event_us;
}

}  // namespace houghstream
