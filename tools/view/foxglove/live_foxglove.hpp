#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "pipeline/base/log_throttle.hpp"
#include "pipeline/bus/channel_pattern.hpp"
#include "pipeline/bus/lcm_bus.hpp"
#include "pipeline/process/byte_budget.hpp"
#include "pipeline/process/reception.hpp"
#include "tools/view/drawing/overlay.hpp"
#include "tools/view/foxglove/foxglove_server.hpp"
#include "tools/view/foxglove/live_conversion.hpp"

namespace houghstream::view {

/// Settings of the stream for Foxglove.
struct LiveFoxgloveSettings {
  std::string address;             ///< [ADDRESS:]PORT
  std::vector<std::string> names;  ///< further names that pages may connect from
  std::string frame_channels;      ///< a ChannelPattern
  std::optional<Camera> camera;    ///< intrinsics of frames that carry none
};

/// Serves the stream to Foxglove: the topics of foxglove::FoxgloveMessages, of all cameras. What arrives is copied, and
/// decoded and converted in a thread of its own and of low priority; without clients nothing is. Where that thread is
/// late, older messages are passed over; how many, is logged at the end.
class LiveFoxglove {
 public:
  using ModelSource = std::function<std::shared_ptr<const ClassModels>()>;

  /// Listens, logs where, and subscribes to `bus`, which must outlive it and is not handled before. `models` is asked
  /// for the models now and then, from any thread. Throws InputError where the address cannot be listened at.
  LiveFoxglove(LcmBus& bus, const LiveFoxgloveSettings& settings, ModelSource models);
  /// The bus must no longer be handled.
  ~LiveFoxglove();
  LiveFoxglove(const LiveFoxglove&) = delete;
  LiveFoxglove& operator=(const LiveFoxglove&) = delete;

  const FoxgloveServer& server() const { return server_; }

 private:
  /// A message that waits.
  struct Waiting {
    std::string channel;
    SharedBytes bytes;
    bool is_frame = false;
    ByteBudget::Reservation reservation;
  };
  void push(const ReceivedMessage& message);
  std::optional<Waiting> pop();
  void run();
  void update_models();
  LiveConversion::Messages convert(const Waiting& waiting);

  ChannelPattern frame_channels_;
  FoxgloveServer server_;
  LiveConversion conversion_;
  ModelSource model_source_;
  std::shared_ptr<const ClassModels> models_;
  LogThrottle complaints_;
  std::mutex mutex_;  // guards the next four
  std::condition_variable filled_;
  ByteBudget bytes_;
  std::deque<Waiting> waiting_;
  std::int64_t passed_over_ = 0;
  std::atomic<bool> is_ending_{false};
  std::thread thread_;
};

}  // namespace houghstream::view
