#include "pipeline/base/stop_signal.hpp"

#include <atomic>
#include <cstdint>
#include <ctime>

namespace houghstream {
namespace {

std::atomic<bool> stop{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may set it");

std::atomic<std::int64_t> stopped_ms{0};  // time at which it was set
static_assert(std::atomic<std::int64_t>::is_always_lock_free, "a signal handler may set it");

std::int64_t now_ms() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);  // may be called from a signal handler
  return std::int64_t{1000} * now.tv_sec + now.tv_nsec / 1'000'000;
}

void on_signal(int number) {
  constexpr std::int64_t kOneRequest = 1000;  // Ctrl-C may reach a process from the terminal and from who started it
  if (!stop.exchange(true)) {
    stopped_ms = now_ms();
  } else if (now_ms() - stopped_ms > kOneRequest) {
    std::signal(number, SIG_DFL);
    std::raise(number);
  }
}

}  // namespace

void catch_stop_signals() {
  stop = false;
  struct sigaction action {};
  action.sa_handler = on_signal;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool stop_requested() {
  return stop;
}

void release_stop_signals() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

BlockStopSignals::BlockStopSignals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, &before_);
}

BlockStopSignals::~BlockStopSignals() {
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

}  // namespace houghstream
