#include "tools/teach/mesh/stop_notice.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <ctime>
#include <utility>

namespace houghstream::teach {

StopNotice::StopNotice(std::string line) : line_(std::move(line)) {
  sigemptyset(&signals_);
  sigaddset(&signals_, SIGINT);
  sigaddset(&signals_, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals_, &before_);
  watcher_ = std::thread([this] { watch(); });
}

StopNotice::~StopNotice() {
  release();
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

void StopNotice::remove_on_stop(const std::filesystem::path& folder) {
  const std::lock_guard<std::mutex> lock(mutex_);
  folder_ = folder;
}

void StopNotice::release() {
  is_over_ = true;
  if (watcher_.joinable()) watcher_.join();
}

void StopNotice::watch() {
  constexpr timespec kTimeout{0, 50'000'000};
  while (!is_over_) {
    const int received = sigtimedwait(&signals_, nullptr, &kTimeout);
    if (received < 0) continue;
    fmt::print(stderr, "{}{}\n", isatty(STDERR_FILENO) == 1 ? "\n" : "", line_);  // below a line of progress
    std::fflush(stderr);
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      std::error_code unremoved;  // the next teaching removes what is left
      if (!folder_.empty()) std::filesystem::remove_all(folder_, unremoved);
    }
    std::signal(received, SIG_DFL);  // who waits for the program sees which signal ended it
    pthread_sigmask(SIG_UNBLOCK, &signals_, nullptr);
    std::raise(received);
  }
}

}  // namespace houghstream::teach
