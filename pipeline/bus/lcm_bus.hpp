#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "pipeline/messages/wire_check.hpp"
#include "pipeline/messages/wire_reader.hpp"

namespace houghstream {

/// A message as it arrived; valid during the handler's call only.
struct Arrival {
  const std::string& channel;
  ByteView bytes;
  std::chrono::steady_clock::time_point time;
  std::int64_t event_us = 0;  ///< when it was received, microseconds since the epoch; of a log, the event's time
};

/// Where messages come from and go to: an LCM network, or, for a file:// URL, a log that is read event by event and
/// never skipped, with results going to another log.
class LcmBus {
 public:
  using Handler = std::function<void(const Arrival&)>;

  /// With ttl=0, messages that other hosts send are dropped by the kernel; with a ttl of 1 or more anybody on the
  /// network may send, and nobody is asked who he is. `url` as LCM takes it; "" is $LCM_DEFAULT_URL, else udpm with
  /// ttl=0. A udpm URL that does not state it gets a recv_buf_size. Logs what is missing where the kernel grants less
  /// than needed, and options that LCM does not know. `output_log` is for file:// only, and may be empty: then nothing
  /// can be published. Throws InputError, also where there is no route to the group.
  explicit LcmBus(const std::string& url, const std::string& output_log = "");
  ~LcmBus();

  /// Calls `handler` for every message of the channels (a ChannelPattern), from within handle(). What the handler
  /// throws is logged, one line a second for each channel. Throws InputError where the network cannot be used, or the
  /// pattern is none.
  void subscribe(const std::string& channels, Handler handler);

  /// Network: waits for one message and handles it, or for `timeout`. Log: handles the next event. False at the end
  /// of a log. Throws InputError where the log is damaged, or, after `timeout`, where the network is not connected.
  bool handle(std::chrono::milliseconds timeout);

  /// May be called from any thread. `utime` is the time of the event where the message goes to a log. Throws InputError
  /// where the message cannot be sent or written.
  void publish(const std::string& channel, ByteView bytes, std::int64_t utime);

  template <typename Message>
  void publish(const std::string& channel, const Message& message) {
    const std::vector<std::uint8_t> bytes = encode_message(message);
    publish(channel, {bytes.data(), bytes.size()}, message.utime);
  }

  /// Ends the output log, if there is one. Throws InputError where it could not be written to the end, or where nothing
  /// was published, naming the channels of the input log: what was in the output's place then stays.
  void close();

  bool is_log() const;
  const std::string& url() const;

 private:
  struct State;
  void refuse_others();

  std::unique_ptr<State> state_;
};

/// Throws InputError where the URL, as LcmBus takes it, is that of a log, and results would go nowhere: there is no
/// output log. For who publishes; asked before a bus is opened.
void require_output_log(const std::string& url, const std::string& output_log);

}  // namespace houghstream
