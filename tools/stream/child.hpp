#pragma once

#include <sys/types.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace houghstream::stream {

/// Receives the notices of a process started from here, in the sd_notify(3) protocol.
class NoticeSocket {
 public:
  /// Opens the socket. Where the system gives none, name() is empty and no notice is ever received.
  NoticeSocket();
  ~NoticeSocket();
  NoticeSocket(const NoticeSocket&) = delete;
  NoticeSocket& operator=(const NoticeSocket&) = delete;

  /// Returns the value of $NOTIFY_SOCKET for the process.
  const std::string& name() const { return name_; }

  /// The time that the process has asked for since the last call (EXTEND_TIMEOUT_USEC), from now on.
  std::optional<std::chrono::microseconds> extension();

 private:
  int socket_;
  std::string name_;
};

/// Gives the exit status of a process, as text, and whether it succeeded.
struct ExitStatus {
  bool success = false;    ///< exit status 0
  bool by_signal = false;  ///< killed, or crashed
  std::string words;       ///< "ended with status 1", "was killed by signal 9 (Killed)"
};

/// A process that this one starts and ends. It has a process group of its own, so that Ctrl-C in the terminal reaches
/// it through this one only, and it gets SIGTERM when this process dies, however that happens. Start it from the thread
/// that lives as long as the process does.
class ChildProcess {
 public:
  /// Starts `command`: program with its path, arguments. With `capture_stderr` its stderr goes through this process,
  /// which stores its last line. Throws InputError when it cannot be started.
  explicit ChildProcess(const std::vector<std::string>& command, bool capture_stderr = false);
  /// Kills it if it still runs.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Returns the exit status, nothing while it runs. Forwards its stderr; call it often.
  std::optional<ExitStatus> poll_exit();
  /// Returns the last line of its stderr, for people; "" where it has written none, or stderr is not captured.
  const std::string& last_stderr_line() const { return last_stderr_line_; }
  /// Returns whether it has recently announced that it is ending and needs more time ($NOTIFY_SOCKET,
  /// EXTEND_TIMEOUT_USEC).
  bool needs_time();
  /// Sends a signal to it and to what it has started.
  void signal(int number) const;
  pid_t pid() const { return pid_; }

 private:
  void pass_on_words();

  NoticeSocket notices_;
  std::chrono::steady_clock::time_point needs_time_until_;
  pid_t pid_ = 0;
  int words_ = -1;  // descriptor from which its stderr is read
  std::string line_;
  std::string last_stderr_line_;
  std::optional<ExitStatus> exit_;
};

}  // namespace houghstream::stream
