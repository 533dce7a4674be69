#include "pipeline/process/process_loop.hpp"

#include <unistd.h>

#include <atomic>
#include <exception>
#include <thread>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/heap_memory.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/base/parallel.hpp"
#include "pipeline/base/service_notice.hpp"
#include "pipeline/base/stop_signal.hpp"

namespace houghstream {
namespace {

using std::chrono::milliseconds;

// Interval at which stop signals are polled.
constexpr milliseconds kPollInterval(100);

// Interval at which freed memory is given back to the system. It takes some milliseconds, in which no thread allocates.
constexpr std::chrono::seconds kMemoryInterval(60);

void play_log(LcmBus& bus, const WorkStep& work, const WorkStep& background) {
  constexpr milliseconds kNoWait(0);
  while (!stop_requested() && bus.handle(kPollInterval)) {
    while (work(kNoWait) || (background && background(kNoWait))) {
    }
  }
  require(!stop_requested(), "{}: stopped before its end, no output is written", bus.url());
}

/// Receives and reports in a thread of its own while it lives.
class Receiver {
 public:
  Receiver(LcmBus& bus, StatusReporter& status, const Heartbeat& work) : bus_(bus), status_(status), work_(work) {
    const BlockStopSignals block;
    thread_ = std::thread([this] { receive(); });
  }
  ~Receiver() { join(); }
  Receiver(const Receiver&) = delete;
  Receiver& operator=(const Receiver&) = delete;

  bool is_running() const { return running_; }

  /// Ends the thread and rethrows what stopped it.
  void finish() {
    join();
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  void join() {
    running_ = false;
    if (thread_.joinable()) thread_.join();
  }

  void receive() noexcept {
    try {
      while (running_) {
        bus_.handle(kPollInterval);
        // A hung process publishes no status.
        if (!work_.is_beating() || !status_.publish_if_due(bus_)) continue;
        notify_service("WATCHDOG=1");
        return_memory_if_due();
      }
    } catch (...) {
      failure_ = std::current_exception();
      running_ = false;
    }
  }

  /// Returns freed memory to the system. A block in use at the heap's end keeps all memory freed before it, so that
  /// each rare peak would stay for good.
  void return_memory_if_due() {
    const auto now = std::chrono::steady_clock::now();
    if (now - memory_returned_ < kMemoryInterval) return;
    memory_returned_ = now;
    return_freed_memory();
    log_debug("freed memory returned in {:.1f} ms",
              std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - now).count());
  }

  LcmBus& bus_;
  StatusReporter& status_;
  const Heartbeat& work_;
  std::chrono::steady_clock::time_point memory_returned_ = std::chrono::steady_clock::now();
  std::atomic<bool> running_{true};
  std::exception_ptr failure_;
  std::thread thread_;
};

/// Works in a thread of its own and of low priority while it lives.
class BackgroundWorker {
 public:
  explicit BackgroundWorker(const WorkStep& work) : work_(work) {
    if (!work_) return;
    const BlockStopSignals block;
    thread_ = std::thread([this] { run(); });
  }
  ~BackgroundWorker() {
    running_ = false;
    if (thread_.joinable()) thread_.join();
  }
  BackgroundWorker(const BackgroundWorker&) = delete;
  BackgroundWorker& operator=(const BackgroundWorker&) = delete;

 private:
  void run() {
    constexpr int kNiceIncrement = 2;
    if (nice(kNiceIncrement) == -1) log_debug("the priority of the work in the background cannot be lowered");
    const SerialScope serial;  // threads that it starts would inherit its priority and be reused by others
    while (running_) work_(kPollInterval);
  }

  const WorkStep& work_;
  std::atomic<bool> running_{true};
  std::thread thread_;
};

}  // namespace

void run_process_loop(LcmBus& bus, StatusReporter& status, const WorkStep& work, const WorkStep& background) {
  if (bus.is_log()) {
    play_log(bus, work, background);
  } else {
    Heartbeat heartbeat;
    const BackgroundWorker worker(background);
    Receiver receiver(bus, status, heartbeat);
    notify_service("READY=1");
    while (!stop_requested() && receiver.is_running()) {
      work(kPollInterval);
      heartbeat.beat();
    }
    notify_service("STOPPING=1");
    receiver.finish();
  }
}

void end_process(LcmBus& bus, StatusReporter& status) {
  if (!bus.is_log()) status.publish(bus);
  const std::string unsent =
      bus.unsent() > 0 ? fmt::format("; {} messages not sent: the bus could not be reached", bus.unsent()) : "";
  log_info("ends: {}{}", status.summary(), unsent);
  bus.close();
}

}  // namespace houghstream
