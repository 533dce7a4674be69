#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

namespace houghstream::stream {

/// How a process ended, in words; whether it did what it was to do.
struct Ending {
  bool success = false;    ///< exit status 0
  bool by_signal = false;  ///< killed, or crashed
  std::string words;       ///< "ended with status 1", "was killed by signal 9 (Killed)"
};

/// A process that this one starts and ends. It has a process group of its own, so that Ctrl-C in the terminal reaches
/// it through this one only, and it gets SIGTERM when this process dies, however that happens. Start it from the thread
/// that lives as long as the process does.
class Child {
 public:
  /// `command`: program with its path, arguments. Throws InputError when it cannot be started.
  explicit Child(const std::vector<std::string>& command);
  /// Kills it if it still runs.
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// How it ended; nothing while it runs.
  std::optional<Ending> ending();
  /// Sends a signal to it and to what it has started.
  void signal(int number) const;
  pid_t pid() const { return pid_; }

 private:
  pid_t pid_ = 0;
  std::optional<Ending> ending_;
};

}  // namespace houghstream::stream
