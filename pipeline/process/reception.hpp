#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/bus/channel_pattern.hpp"
#include "pipeline/bus/lcm_bus.hpp"
#include "pipeline/bus/status_reporter.hpp"
#include "pipeline/types/frame_id.hpp"

namespace houghstream {

/// The bytes of an encoded frame, copied once from the bus and shared by all who keep them.
using SharedBytes = std::shared_ptr<const std::vector<std::uint8_t>>;
SharedBytes shared_copy(ByteView bytes);

/// A received frame; its bytes are valid during the handler's call only.
struct ReceivedFrame {
  FrameId id;
  FrameOrder order = FrameOrder::kNext;
  ByteView bytes;
  std::chrono::steady_clock::time_point time;
};

/// A received frame that waits to be decoded.
struct EncodedFrame {
  FrameId id;
  SharedBytes bytes;
  std::chrono::steady_clock::time_point arrival;
};

/// Received detections or poses, with the frame that they are about; the bytes are valid during the handler's call
/// only.
struct ReceivedResult {
  FrameId id;
  ByteView bytes;
  std::chrono::steady_clock::time_point time;
};

/// Selects how status_t counts a subscription's messages: as received and refused, or only their faults, separately.
enum class CountedAs { kReceived, kOther };

/// Subscribes to what a process works on, and checks and counts each message before the process sees it. A message that
/// cannot be understood, or that its handler refuses with an InputError, is counted and logged, one line a second of
/// its channel. On a network a duplicate is dropped and counted; of a log every message is processed. The
/// handlers are called in the thread that calls LcmBus::handle(). Must outlive the bus' last call of handle().
class Reception {
 public:
  /// Maximum size of a result, about that of two thousand detections; larger ones are refused.
  static constexpr std::size_t kMaxResultBytes = std::size_t{1} << 20U;

  using FrameHandler = std::function<void(const ReceivedFrame&)>;
  using ResultHandler = std::function<void(const ReceivedResult&)>;
  using OtherCameraHandler = std::function<void(const FrameId&)>;

  /// `frame_channels` is a ChannelPattern: where it is an expression, messages of other types than images_t on these
  /// channels are ignored. `keep_frames`: frames, and results of them, are copied to the output log as they come.
  /// Throws InputError where that is asked for without a log.
  Reception(LcmBus& bus, StatusReporter& status, const std::string& frame_channels, bool keep_frames = false);

  void subscribe_to_frames(CountedAs counted_as, FrameHandler handler);

  /// Receives results; those of frames on other channels than `frame_channels` are not counted, and only `other_camera`
  /// is called.
  template <typename Message>
  void subscribe_to_results(const std::string& channel, CountedAs counted_as, ResultHandler handler,
                            OtherCameraHandler other_camera = {}) {
    subscribe_to_results({Message::getHash(), Message::getTypeName()}, channel, counted_as,
                         {std::move(handler), std::move(other_camera)});
  }

  /// Receives messages that are neither frames nor results, decoded.
  template <typename Message>
  void subscribe_to_messages(const std::string& channels,
                             std::function<void(const Message&, const ReceivedMessage&)> handler) {
    bus_.subscribe(channels, [this, handler = std::move(handler)](const ReceivedMessage& message) {
      receive(message, CountedAs::kOther, [&] {
        handler(decode_message<Message>(message.bytes), message);
        return true;
      });
    });
  }

  /// Returns the time of a monotonic clock, microseconds; of a log, the sum of the forward steps from event to event.
  /// For a log only the thread that handles the bus may call it.
  std::int64_t now_us() const;

 private:
  struct MessageType {
    std::int64_t fingerprint = 0;
    std::string name;
  };
  struct ResultHandlers {
    ResultHandler handler;
    OtherCameraHandler other_camera;
  };

  void subscribe_to_results(MessageType type, const std::string& channel, CountedAs counted_as,
                            ResultHandlers handlers);
  /// `handle` returns whether the message counts.
  void receive(const ReceivedMessage& message, CountedAs counted_as, const std::function<bool()>& handle);
  bool handle_frame(const ReceivedMessage& message, const FrameHandler& handler);
  bool handle_result(const ReceivedMessage& message, const ResultHandlers& handlers, DuplicateFilter& duplicates);
  void advance_log_clock(const ReceivedMessage& message);

  LcmBus& bus_;
  StatusReporter& status_;
  ChannelPattern pattern_;
  bool keep_frames_;
  std::optional<std::int64_t> event_us_;  // time of a log's last event
  std::int64_t log_clock_us_ = 0;
};

}  // namespace houghstream
