#pragma once

#include <atomic>
#include <csignal>
#include <filesystem>
#include <mutex>
#include <string>
#include <thread>

namespace houghstream::teach {

/// While it lives, SIGINT and SIGTERM end the program with a line on stderr that says what is left, where they would
/// else end it without a word. Threads that are started meanwhile never receive them. To be made before any others
/// are; what is not to be interrupted, as the exchange of a store, follows after release().
class StopNotice {
 public:
  explicit StopNotice(std::string line);
  ~StopNotice();
  StopNotice(const StopNotice&) = delete;
  StopNotice& operator=(const StopNotice&) = delete;

  /// A signal removes this folder too, with all that is in it.
  void remove_on_stop(const std::filesystem::path& folder);

  /// Lets the signals wait from here on until this one is gone.
  void release();

 private:
  void watch();

  std::string line_;
  std::mutex mutex_;
  std::filesystem::path folder_;  // guarded by the mutex; empty without one
  sigset_t signals_{};
  sigset_t before_{};
  std::atomic<bool> is_over_{false};
  std::thread watcher_;
};

}  // namespace houghstream::teach
