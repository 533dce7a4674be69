#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>

namespace houghstream {

/// Sends words of the sd_notify(3) protocol to the service manager that $NOTIFY_SOCKET names: "READY=1" when a program
/// has started, "WATCHDOG=1" while it works. Without a manager nothing happens. May be called from any thread.
void notify_service(const std::string& words);

/// While it exists, the service manager (systemd, hs-stream) is notified once a second that this program is ending and
/// needs more time, since a video or a recording is still being written. The notices end after ten minutes.
class StillFinishing {
 public:
  /// Each request asks for this much more time.
  static constexpr std::chrono::seconds kExtension{5};
  static constexpr std::chrono::minutes kMaxLength{10};

  enum class From {
    kNow,
    kStopSignal  ///< once one has arrived; a low-priority program notices it itself much later
  };

  explicit StillFinishing(From from = From::kNow);
  ~StillFinishing();
  StillFinishing(const StillFinishing&) = delete;
  StillFinishing& operator=(const StillFinishing&) = delete;

 private:
  std::mutex mutex_;
  std::condition_variable ends_;
  bool has_ended_ = false;
  std::thread thread_;
};

/// Heartbeat of the thread that does a program's work. A thread without a heartbeat for longer than any step of work
/// takes counts as hung; a hung program publishes no status and is restarted by its supervisor (hs-stream, systemd).
/// May be used from any thread.
class Heartbeat {
 public:
  /// The longest that a step of work may take.
  static constexpr std::chrono::seconds kHeartbeatTimeout{5};

  void beat() { last_ = now(); }
  bool is_beating() const { return now() - last_ < std::chrono::nanoseconds(kHeartbeatTimeout).count(); }

 private:
  static std::int64_t now() { return std::chrono::steady_clock::now().time_since_epoch().count(); }
  std::atomic<std::int64_t> last_{now()};
};

}  // namespace houghstream
