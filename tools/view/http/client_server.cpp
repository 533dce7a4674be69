#include "tools/view/http/client_server.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <string>

namespace houghstream::view {
namespace {

using Clock = ClientTable::Clock;

/// Reads and writes the bytes of one connection. A broken connection stays broken: nothing is read or written any more.
class ClientStream final : public httplib::Stream {
 public:
  ClientStream(socket_t socket, ClientTable& clients) : socket_(socket), clients_(clients) {}

  /// Waits for the first bytes of a request. False where none comes.
  bool wait_for_request();
  /// The request's header has been read.
  void end_header();

  bool is_readable() const override { return begin_ < end_; }
  bool is_writable() const override { return !broken_; }
  ssize_t read(char* to, std::size_t size) override;
  ssize_t write(const char* from, std::size_t size) override;
  /// The address of the client is unused.
  void get_remote_ip_and_port(std::string& /*ip*/, int& /*port*/) const override {}
  void get_local_ip_and_port(std::string& /*ip*/, int& /*port*/) const override {}
  socket_t socket() const override { return socket_; }

 private:
  bool receive();
  /// Waits until the socket can be read or written, as `events` states, or has ended. Returns false where that takes
  /// too long, or other connections need the thread.
  bool wait_for(short events, Clock::time_point deadline);

  socket_t socket_;
  ClientTable& clients_;
  std::array<char, 4096> buffer_{};
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  std::size_t request_bytes_left_ = 0;
  Clock::time_point deadline_;  // deadline of the request
  bool broken_ = false;
};

bool ClientStream::wait_for_request() {
  if (broken_) return false;
  clients_.note_waiting(socket_);
  request_bytes_left_ = ClientServer::kMaxRequestBytes;
  deadline_ = Clock::now() + ClientServer::kRequestTimeout;
  const bool there = begin_ < end_ || receive();
  deadline_ = Clock::now() + ClientServer::kRequestTimeout;
  return there;
}

void ClientStream::end_header() {
  clients_.note_working(socket_);
}

bool ClientStream::wait_for(short events, Clock::time_point deadline) {
  constexpr std::chrono::milliseconds kSlice(50);
  clients_.note_waiting(socket_);
  while (true) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
    if (left.count() <= 0) return false;
    pollfd asked{socket_, events, 0};
    const int ready = poll(&asked, 1, static_cast<int>(std::min(left, kSlice).count()));
    if (ready > 0) return true;
    if ((ready < 0 && errno != EINTR) || clients_.must_yield(socket_)) return false;
  }
}

bool ClientStream::receive() {
  // A client that sends a byte at a time never lets wait_for() wait long.
  const bool has_begun = request_bytes_left_ < ClientServer::kMaxRequestBytes;
  broken_ = broken_ || (has_begun && clients_.must_yield(socket_));
  if (broken_) return false;
  const ssize_t received =
      wait_for(POLLIN, deadline_) ? recv(socket_, buffer_.data(), buffer_.size(), MSG_DONTWAIT) : 0;
  broken_ = received <= 0;
  begin_ = 0;
  end_ = broken_ ? 0 : static_cast<std::size_t>(received);
  return !broken_;
}

ssize_t ClientStream::read(char* to, std::size_t size) {
  broken_ = broken_ || request_bytes_left_ == 0;
  if (broken_ || (begin_ == end_ && !receive())) return -1;
  const std::size_t part = std::min({size, end_ - begin_, request_bytes_left_});
  std::copy_n(buffer_.data() + begin_, part, to);
  begin_ += part;
  request_bytes_left_ -= part;
  return static_cast<ssize_t>(part);
}

ssize_t ClientStream::write(const char* from, std::size_t size) {
  const std::chrono::milliseconds for_size(1000 * size / ClientServer::kMinBytesPerS);
  const Clock::time_point deadline = Clock::now() + ClientServer::kWriteTimeout + for_size;
  clients_.note_working(socket_);
  for (std::size_t sent = 0; sent < size && !broken_;) {
    const ssize_t part = send(socket_, from + sent, size - sent, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (part > 0) {
      sent += static_cast<std::size_t>(part);
    } else {
      broken_ = (errno != EAGAIN && errno != EINTR) || clients_.must_yield(socket_) || !wait_for(POLLOUT, deadline);
    }
  }
  clients_.note_working(socket_);
  return broken_ ? -1 : static_cast<ssize_t>(size);
}

/// Leaves it to the server's own pool when a connection is served.
class NoQueue final : public httplib::TaskQueue {
 public:
  explicit NoQueue(httplib::ThreadPool& pool) : pool_(pool) {}
  void enqueue(std::function<void()> task) override { task(); }
  void shutdown() override { pool_.shutdown(); }

 private:
  httplib::ThreadPool& pool_;
};

}  // namespace

bool ClientTable::admit(socket_t socket) {
  const std::lock_guard lock(mutex_);
  if (closed_ || clients_.size() >= max_clients_) {
    ::close(socket);
    return false;
  }
  clients_[socket] = {};
  return true;
}

void ClientTable::begin(socket_t socket) {
  const std::lock_guard lock(mutex_);
  clients_.at(socket).begun = true;
}

bool ClientTable::must_yield(socket_t socket) {
  const std::lock_guard lock(mutex_);
  const std::optional<Clock::time_point> since = clients_.at(socket).waiting_since;
  if (!since || Clock::now() - *since < kGrace) return false;
  std::ptrdiff_t in_want = 0;
  std::ptrdiff_t longer = 0;
  for (const auto& [other, client] : clients_) {
    if (!client.begun) ++in_want;
    if (client.waiting_since && *client.waiting_since < *since) ++longer;
  }
  return longer < in_want;
}

void ClientTable::note_waiting(socket_t socket) {
  const std::lock_guard lock(mutex_);
  Client& client = clients_.at(socket);
  if (!client.waiting_since) client.waiting_since = Clock::now();
}

void ClientTable::note_working(socket_t socket) {
  const std::lock_guard lock(mutex_);
  clients_.at(socket).waiting_since.reset();
}

void ClientTable::remove(socket_t socket) {
  const std::lock_guard lock(mutex_);
  clients_.erase(socket);
  shutdown(socket, SHUT_RDWR);
  ::close(socket);
}

void ClientTable::close() {
  const std::lock_guard lock(mutex_);
  closed_ = true;
  for (const auto& [socket, client] : clients_) shutdown(socket, SHUT_RDWR);
}

ClientServer::ClientServer(std::size_t threads) : clients_(4 * threads) {
  // Called by the thread that accepts: those of the pool have its priority.
  new_task_queue = [this, threads] {
    pool_ = std::make_unique<httplib::ThreadPool>(threads);
    return new NoQueue(*pool_);
  };
  set_keep_alive_timeout(kRequestTimeout.count());
}

void ClientServer::enlarge_backlog() {
  constexpr int kBacklog = 128;
  ::listen(svr_sock_, kBacklog);
}

// Called by the thread that accepts.
bool ClientServer::process_and_close_socket(socket_t socket) {
  // A client that reads nothing is noticed once this is full.
  constexpr int kSendBuffer = 32'768;
  setsockopt(socket, SOL_SOCKET, SO_SNDBUF, &kSendBuffer, sizeof(kSendBuffer));
  if (!clients_.admit(socket)) return false;
  pool_->enqueue([this, socket] { serve(socket); });
  return true;
}

void ClientServer::serve(socket_t socket) {
  clients_.begin(socket);
  ClientStream stream(socket, clients_);
  bool closed = false;
  const auto prepare = [&stream](httplib::Request& request) {
    stream.end_header();
    request.ranges.clear();
  };
  while (!closed && stream.wait_for_request() && process_request(stream, false, closed, prepare)) {
  }
  clients_.remove(socket);
}

}  // namespace houghstream::view
