#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "pipeline/bus/channels.hpp"
#include "pipeline/bus/lcm_bus.hpp"
#include "pipeline/types/frame.hpp"

namespace houghstream::teach {

/// Which frames of a stream are a take.
struct StreamTakeSettings {
  std::string channel = channel::kFrame;  ///< of one camera's frames
  std::optional<Camera> camera;           ///< of frames that carry none of their own
  std::chrono::milliseconds longest{60'000};
  std::chrono::milliseconds patience{10'000};  ///< with the first frame
  std::chrono::milliseconds silence{3'000};    ///< after which the stream counts as ended
};

/// A take that comes off the bus while the stream goes on. A thread receives, so that none of the frames waits in LCM;
/// the one who follows the object takes them in order.
class StreamTake {
 public:
  /// Listens from here on to `bus`, which must outlive it. Throws InputError where it is a log.
  StreamTake(LcmBus& bus, StreamTakeSettings settings);
  ~StreamTake();
  StreamTake(const StreamTake&) = delete;
  StreamTake& operator=(const StreamTake&) = delete;

  /// The next frame; waits for it. Nothing at the take's end: after end() or a stop signal, as soon as `longest` has
  /// passed since the first frame, or where no frame comes for `silence`. Throws InputError where none comes at all,
  /// receiving fails, or a frame cannot be understood.
  std::optional<RgbdFrame> next();

  /// The take is long enough. May be called from any thread.
  void end();

  /// Of the frames that wait, only the newest is taken.
  void skip_to_newest();

  /// Frames that came too fast: of those that wait the oldest goes.
  std::int64_t passed_over() const { return passed_over_; }

 private:
  using Clock = std::chrono::steady_clock;
  void put(const Arrival& arrival);
  void receive() noexcept;
  std::optional<std::vector<std::uint8_t>> take();
  std::vector<std::uint8_t> take_first();
  Clock::time_point deadline() const;

  LcmBus& bus_;
  StreamTakeSettings settings_;
  Clock::time_point begin_ = Clock::now();
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::vector<std::uint8_t>> waiting_;  // encoded
  std::size_t waiting_bytes_ = 0;
  std::optional<Clock::time_point> first_;  // when it came
  Clock::time_point last_ = Clock::now();
  bool ended_ = false;
  std::string failure_;
  std::atomic<std::int64_t> passed_over_{0};
  std::atomic<bool> receiving_{true};
  std::thread thread_;
};

}  // namespace houghstream::teach
