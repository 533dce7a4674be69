#pragma once

#include <httplib.h>

#include <chrono>
#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <optional>

namespace houghstream::view {

/// Tracks the connections of a server, and which of them wait for their client: for the bytes of a request, or until it
/// accepts a response. Where other connections need a thread, those that have waited longest yield theirs. So a client
/// that sends nothing, or reads nothing, does not block the server. Any function may be called from any thread.
class ClientTable {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds kGrace{100};  ///< minimum wait before a connection yields

  /// Opens at most `max_clients` connections.
  explicit ClientTable(std::size_t max_clients) : max_clients_(max_clients) {}

  /// Adds a connection, which is in want of a thread until begin(). Closes it and returns false where too many are
  /// open, or after close().
  bool admit(socket_t socket);
  void begin(socket_t socket);
  /// Notes that the connection waits for its client from now on, unless it does so already.
  void note_waiting(socket_t socket);
  void note_working(socket_t socket);
  bool must_yield(socket_t socket);
  /// Closes the connection.
  void remove(socket_t socket);
  /// Ends all connections, and those that come later.
  void close();

 private:
  struct Client {
    bool begun = false;
    std::optional<Clock::time_point> waiting_since;
  };

  std::size_t max_clients_;
  std::mutex mutex_;
  std::map<socket_t, Client> clients_;
  bool closed_ = false;
};

/// Limits cpp-httplib's server: a request must arrive within kRequestTimeout and have at most kMaxRequestBytes, the
/// client must accept at least kMinBytesPerS, too many clients are handled as in ClientTable, and ranges are ignored,
/// which HTTP allows: the library would build each of the thousands that one header can ask for.
class ClientServer final : public httplib::Server {
 public:
  static constexpr std::chrono::seconds kRequestTimeout{5};  ///< also the maximum idle time between requests
  static constexpr std::chrono::seconds kWriteTimeout{5};    ///< plus the time that kMinBytesPerS takes
  static constexpr std::size_t kMinBytesPerS = 32'768;
  static constexpr std::size_t kMaxRequestBytes = 65'536;

  explicit ClientServer(std::size_t threads);

  /// Enlarges the queue of connections that wait to be accepted, which the library limits to five: a crowd's sixth
  /// would try again after a second. Called between bind_to_port() and the start of the thread that accepts, since
  /// stop() may close the socket as soon as that thread runs.
  void enlarge_backlog();

  /// Ends all connections, so that stop() waits for none.
  void end_clients() { clients_.close(); }

 private:
  bool process_and_close_socket(socket_t socket) override;
  void serve(socket_t socket);

  ClientTable clients_;
  std::unique_ptr<httplib::ThreadPool> pool_;
};

}  // namespace houghstream::view
