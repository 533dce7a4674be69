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

/// An encoded frame's bytes, which are copied once, off the bus, however many keep them.
using SharedBytes = std::shared_ptr<const std::vector<std::uint8_t>>;
SharedBytes shared_copy(ByteView bytes);

/// A frame as it has arrived; its bytes are valid during the handler's call only.
struct ReceivedFrame {
  FrameId id;
  FrameOrder order = FrameOrder::kNext;
  ByteView bytes;
  std::chrono::steady_clock::time_point time;
};

/// A frame that is kept until it is worked on.
struct EncodedFrame {
  FrameId id;
  SharedBytes bytes;
  std::chrono::steady_clock::time_point arrival;
};

/// Detections or poses as they have arrived, with the frame that they are about; the bytes likewise.
struct ReceivedResult {
  FrameId id;
  ByteView bytes;
  std::chrono::steady_clock::time_point time;
};

/// Account of a subscription: messages that status_t counts as received and refused, or others, whose faults are
/// counted separately.
enum class Account { kReceived, kOthers };

/// Subscribes to what a process works on, and checks and counts each message before the process sees it. A message that
/// cannot be understood, or that its handler refuses with an InputError, is counted and logged, one line a second of
/// its channel. On a network a duplicate is dropped and counted; of a log every message is processed. The
/// handlers are called in the thread that calls LcmBus::handle(). Must outlive the bus' last call of handle().
class Reception {
 public:
  /// Maximum size of a result, which two thousand detections have; larger ones are refused.
  static constexpr std::size_t kMaxResultBytes = std::size_t{1} << 20U;

  using FrameHandler = std::function<void(const ReceivedFrame&)>;
  using ResultHandler = std::function<void(const ReceivedResult&)>;
  using OtherCameraHandler = std::function<void(const FrameId&)>;

  /// `frame_channels` is a ChannelPattern: where it is an expression, what is no images_t on these channels is passed
  /// over. `keep`: frames, and results of them, go to the output log as they come. Throws InputError where they are to
  /// be kept without a log.
  Reception(LcmBus& bus, StatusReporter& status, const std::string& frame_channels, bool keep = false);

  void subscribe_to_frames(Account account, FrameHandler handler);

  /// Receives results; those of frames on other channels than `frame_channels` are not counted, and only `other_camera`
  /// is called.
  template <typename Message>
  void subscribe_to_results(const std::string& channel, Account account, ResultHandler handler,
                            OtherCameraHandler other_camera = {}) {
    subscribe_to_results({Message::getHash(), Message::getTypeName()}, channel, account,
                         {std::move(handler), std::move(other_camera)});
  }

  /// Receives messages that are neither frames nor results, decoded.
  template <typename Message>
  void subscribe_to_messages(const std::string& channels,
                             std::function<void(const Message&, const ReceivedMessage&)> handler) {
    bus_.subscribe(channels, [this, handler = std::move(handler)](const ReceivedMessage& message) {
      receive(message, Account::kOthers, [&] {
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

  void subscribe_to_results(MessageType type, const std::string& channel, Account account, ResultHandlers handlers);
  /// `take` returns whether the message counts.
  void receive(const ReceivedMessage& message, Account account, const std::function<bool()>& take);
  bool take_frame(const ReceivedMessage& message, const FrameHandler& handler);
  bool take_result(const ReceivedMessage& message, const ResultHandlers& handlers, DuplicateFilter& duplicates);
  void note_event(const ReceivedMessage& message);

  LcmBus& bus_;
  StatusReporter& status_;
  ChannelPattern pattern_;
  bool keep_;
  std::optional<std::int64_t> event_us_;  // time of a log's last event
  std::int64_t log_us_ = 0;
};

}  // namespace houghstream
