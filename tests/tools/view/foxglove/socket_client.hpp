#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>

namespace houghstream::view {

/// A client of WebSockets (RFC 6455) in its barest form, for tests: short requests, whole frames.
class SocketClient {
 public:
  explicit SocketClient(int port, int receive_buffer = 0) : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
    if (receive_buffer > 0) setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    is_open_ = connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  }
  ~SocketClient() { close(socket_); }
  SocketClient(const SocketClient&) = delete;
  SocketClient& operator=(const SocketClient&) = delete;

  /// Returns the answer's head, "HTTP/1.1 101 ...".
  std::string shake_hands(const std::string& more = "Sec-WebSocket-Protocol: foxglove.websocket.v1\r\n") {
    write(
        "GET / HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
        "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
        more + "\r\n");
    while (buffer_.find("\r\n\r\n") == std::string::npos && read()) {
    }
    const std::size_t end = buffer_.find("\r\n\r\n");
    const std::string head = buffer_.substr(0, end);
    buffer_.erase(0, end == std::string::npos ? end : end + 4);
    return head;
  }

  /// Returns the whole answer to a request for a page.
  std::string get_page() {
    write("GET / HTTP/1.1\r\nHost: localhost\r\n\r\n");
    while (read()) {
    }
    return buffer_;
  }

  /// Sends a text of at most 125 bytes, masked with zeros.
  void send_text(const std::string& text) {
    write(std::string("\x81") + static_cast<char>(0x80U | text.size()) + std::string(4, '\0') + text);
  }

  /// A frame: its first byte, and its content.
  struct Frame {
    int opcode = 0;
    std::string content;
  };

  /// Returns the next frame, or nothing where the connection ends or no byte comes within the timeout.
  std::optional<Frame> next(std::chrono::milliseconds timeout = std::chrono::seconds(1)) {
    while (true) {
      if (std::optional<Frame> frame = parse()) return frame;
      if (!read(timeout)) return std::nullopt;
    }
  }

 private:
  void write(const std::string& bytes) const {
    if (is_open_) (void)!::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  }

  bool read(std::chrono::milliseconds timeout = std::chrono::seconds(1)) {
    pollfd waits{socket_, POLLIN, 0};
    if (!is_open_ || poll(&waits, 1, static_cast<int>(timeout.count())) <= 0) return false;
    std::string chunk(65536, '\0');
    const ssize_t size = recv(socket_, chunk.data(), chunk.size(), 0);
    if (size <= 0) return false;
    buffer_.append(chunk, 0, static_cast<std::size_t>(size));
    return true;
  }

  std::optional<Frame> parse() {
    if (buffer_.size() < 2) return std::nullopt;
    std::size_t length = static_cast<unsigned char>(buffer_[1]);
    std::size_t head = 2;
    if (length >= 126) {
      const std::size_t bytes = length == 126 ? 2 : 8;
      head += bytes;
      if (buffer_.size() < head) return std::nullopt;
      length = 0;
      for (std::size_t i = 2; i < head; ++i) length = length << 8U | static_cast<unsigned char>(buffer_[i]);
    }
    if (buffer_.size() < head + length) return std::nullopt;
    Frame frame{buffer_[0] & 0x0F, buffer_.substr(head, length)};
    buffer_.erase(0, head + length);
    return frame;
  }

  int socket_;
  bool is_open_ = false;
  std::string buffer_;
};

}  // namespace houghstream::view
