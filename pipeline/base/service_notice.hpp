#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <string>

namespace houghstream {

/// Sends words of the sd_notify(3) protocol to the service manager that $NOTIFY_SOCKET names: "READY=1" when a program
/// has started, "WATCHDOG=1" while it works. Without a manager nothing happens. May be called from any thread.
void notify_service(const std::string& words);

/// Whether the thread that does a program's work still does it: it beats, others ask. What stands still for longer than
/// any step of work takes hangs; a program that hangs says nothing more of itself, and is started again by who listens
/// (hs-stream, systemd). May be used from any thread.
class Heartbeat {
 public:
  /// The longest that a step of work may take.
  static constexpr std::chrono::seconds kPatience{5};

  void beat() { last_ = now(); }
  bool is_beating() const { return now() - last_ < std::chrono::nanoseconds(kPatience).count(); }

 private:
  static std::int64_t now() { return std::chrono::steady_clock::now().time_since_epoch().count(); }
  std::atomic<std::int64_t> last_{now()};
};

}  // namespace houghstream
