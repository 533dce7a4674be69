#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "pipeline/base/files.hpp"
#include "pipeline/messages/wire_check.hpp"
#include "pipeline/messages/wire_reader.hpp"

namespace houghstream {

/// Holds a message as it arrived; it is valid during the handler's call only.
struct ReceivedMessage {
  const std::string& channel;
  ByteView bytes;
  std::chrono::steady_clock::time_point time;
  std::int64_t event_us = 0;  ///< reception time, microseconds since the epoch; of a log, the event's time
};

/// Behaviour of LcmBus where its network cannot be reached at its start.
enum class AtStart { kWait, kFail };

/// Connects to the source and destination of messages: an LCM network, or, for a file:// URL, a log that is read event
/// by event and never skipped, with results going to another log.
///
/// A network that cannot be reached (a link that is down, no route, a server that is gone) is waited for. Each outage
/// is logged once when it begins and once when it ends; meanwhile nothing is received, and what is published is counted
/// (unsent()) and lost. Within half a second of the network's return the messages of all subscriptions come again.
class LcmBus {
 public:
  using Handler = std::function<void(const ReceivedMessage&)>;

  /// Opens the bus. With ttl=0, messages that other hosts send are dropped by the kernel; with a ttl of 1 or more
  /// anybody on the network may send, without authentication. `url` is an LCM URL; "" is $LCM_DEFAULT_URL, else udpm
  /// with ttl=0. A udpm URL that does not state it gets a recv_buf_size. Logs what is missing where the kernel grants
  /// less than needed, and options that LCM does not know. `output_log` is for file:// only, and may be empty: then
  /// nothing can be published; `existing` is the treatment of one that exists. Waits for a route to the group of a udpm
  /// URL, and tells a service manager that this takes time. Throws InputError, also where a stop signal ends the
  /// waiting, or `at_start` is kFail and there is no route.
  explicit LcmBus(const std::string& url, const std::string& output_log = "", Existing existing = Existing::kReplaced,
                  AtStart at_start = AtStart::kWait);
  ~LcmBus();

  /// Calls `handler` for every message of the channels (a ChannelPattern), from within handle(). What the handler
  /// throws is logged, one line a second for each channel. Waits for the network as the constructor does. Throws
  /// InputError as it does, and where the pattern is none.
  void subscribe(const std::string& channels, Handler handler);

  /// Subscribes as subscribe() does, but any number of messages may wait for handle(), where LCM else drops what comes
  /// in a burst without saying so. For a recorder, which handles at once and bounds its memory itself.
  void subscribe_unbounded(const std::string& channels, Handler handler);

  /// Subscribes to frames: where none arrives on these channels for three seconds while the network can be reached, the
  /// channels on which frames arrive are logged.
  void subscribe_to_frames(const std::string& channels, Handler handler);

  /// Handles one message. On a network it waits for the message for up to `timeout`; of a log it handles the next
  /// event. Returns false at the end of a log. Throws InputError where the log is damaged.
  bool handle(std::chrono::milliseconds timeout);

  /// Publishes a message; may be called from any thread. `utime` is the time of the event where the message goes to a
  /// log. Returns false where the network cannot be reached. Throws InputError where the message cannot be written, or
  /// the name of the channel is longer than a network allows.
  bool publish(const std::string& channel, ByteView bytes, std::int64_t utime);

  template <typename Message>
  bool publish(const std::string& channel, const Message& message) {
    const std::vector<std::uint8_t> bytes = encode_message(message);
    return publish(channel, {bytes.data(), bytes.size()}, message.utime);
  }

  /// Returns whether the network could be reached at the last check, which handle() and publish() make four times a
  /// second. May be called from any thread, as may the next two.
  bool is_reachable() const;

  /// Messages that were not sent because the network could not be reached.
  std::int64_t unsent() const;

  /// Describes the last outage that has ended; empty before the first one.
  std::string last_outage() const;

  /// Ends the output log, if there is one. Throws InputError where it could not be written to the end, or where nothing
  /// was published, naming the channels of the input log: what was in the output's place then stays.
  void close();

  bool is_log() const;
  const std::string& url() const;

 private:
  struct State;
  void open_network();
  void wait_until_reachable();
  void add_subscription(const std::string& channels, Handler handler, bool is_bounded);
  void subscribe_to_network();
  void refuse_others();
  void look_at_network();
  void reconnect();
  void look_for_frames();
  bool send(const std::string& channel, ByteView bytes);

  std::unique_ptr<State> state_;
};

/// Throws InputError where the URL, as LcmBus takes it, is that of a log, and results would go nowhere: there is no
/// output log. For who publishes; asked before a bus is opened.
void require_output_log(const std::string& url, const std::string& output_log);

// The names of before, for one release.
using Arrival [[deprecated("is ReceivedMessage now")]] = ReceivedMessage;

}  // namespace houghstream
