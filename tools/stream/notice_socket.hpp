#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace houghstream::stream {

/// Where a process that was started from here says how it is, in the words of the sd_notify(3) protocol.
class NoticeSocket {
 public:
  /// Without a socket, where the system gives none, name() is empty and nothing is ever heard.
  NoticeSocket();
  ~NoticeSocket();
  NoticeSocket(const NoticeSocket&) = delete;
  NoticeSocket& operator=(const NoticeSocket&) = delete;

  /// For $NOTIFY_SOCKET of the process.
  const std::string& name() const { return name_; }

  /// The time that the process has asked for since the last call (EXTEND_TIMEOUT_USEC), from now on.
  std::optional<std::chrono::microseconds> extension();

 private:
  int socket_;
  std::string name_;
};

}  // namespace houghstream::stream
