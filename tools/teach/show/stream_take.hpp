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

#include "pipeline/base/log_throttle.hpp"
#include "pipeline/bus/lcm_bus.hpp"
#include "pipeline/messages/channels.hpp"
#include "pipeline/types/frame.hpp"

namespace houghstream::teach {

/// Settings that decide which frames of a stream are a take.
struct StreamTakeSettings {
  std::string channel = channel::kFrame;  ///< channel of one camera's frames
  std::optional<Camera> camera;           ///< camera of frames that carry none of their own
  std::chrono::milliseconds max_length{60'000};
  std::chrono::milliseconds first_frame_timeout{10'000};  ///< timeout of the first frame
  std::chrono::milliseconds frame_timeout{3'000};  ///< time without a frame, after which the stream counts as ended
};

/// A take that is received from the bus while the stream runs. A thread receives, so that no frame waits in LCM; the
/// thread that follows the object pops the frames in their order. A message that is no frame of the take (rubbish, a
/// damaged image, no camera, or another image size than the first frame had) is dropped with a count, and one line a
/// second says so.
class StreamTake {
 public:
  /// Listens from here on to `bus`, which must outlive it. Throws InputError where it is a log.
  StreamTake(LcmBus& bus, StreamTakeSettings settings);
  ~StreamTake();
  StreamTake(const StreamTake&) = delete;
  StreamTake& operator=(const StreamTake&) = delete;

  /// Returns the next frame; waits for it. Returns nothing at the take's end: after end() or a stop signal, as soon as
  /// `max_length` has passed since the first frame, or where no frame comes for `frame_timeout`. Throws InputError
  /// where none comes within `first_frame_timeout`, or receiving fails. Time in which the bus cannot be reached counts
  /// for none of these.
  std::optional<RgbdFrame> next();

  /// Ends the take. It may be called from any thread.
  void end();

  /// Drops all waiting frames but the newest.
  void skip_to_newest();

  /// Returns the number of frames that came too fast: of those that wait the oldest is dropped.
  std::int64_t passed_over() const { return passed_over_; }

  /// Returns the number of messages on the channel that are no frame of the take.
  std::int64_t refused() const { return refused_; }

 private:
  using Clock = std::chrono::steady_clock;
  struct Waiting {
    std::vector<std::uint8_t> bytes;  // encoded
    Clock::time_point arrival;
  };
  void push(const ReceivedMessage& arrival);
  void refuse(const std::string& reason);
  void receive() noexcept;
  std::optional<Waiting> pop();
  Waiting pop_first();
  void drop_first();
  void note_outage(Clock::duration time);
  RgbdFrame decode(const std::vector<std::uint8_t>& bytes) const;
  void note_frame(const RgbdFrame& frame, Clock::time_point arrival);
  Clock::time_point deadline() const;
  void require_stream() const;

  LcmBus& bus_;
  StreamTakeSettings settings_;
  Clock::time_point begin_ = Clock::now();
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Waiting> waiting_;
  std::size_t waiting_bytes_ = 0;
  std::optional<Clock::time_point> first_;  // arrival of the first frame
  Clock::time_point last_;                  // arrival of the last frame that was popped or dropped
  cv::Size size_;                           // size of the first frame
  std::string last_reason_;                 // why the last message was refused
  LogThrottle throttle_;
  bool ended_ = false;
  std::string failure_;
  std::atomic<std::int64_t> passed_over_{0};
  std::atomic<std::int64_t> refused_{0};
  std::atomic<bool> receiving_{true};
  std::thread thread_;
};

}  // namespace houghstream::teach
