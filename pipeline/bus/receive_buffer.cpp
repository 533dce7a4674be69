#include "pipeline/bus/receive_buffer.hpp"

#include <fmt/format.h>
#include <linux/sock_diag.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "pipeline/base/checks.hpp"

namespace houghstream {

std::string with_receive_buffer(const std::string& url, std::int64_t bytes) {
  const bool is_udpm = url.rfind("udpm://", 0) == 0;
  if (!is_udpm || url.find("recv_buf_size=") != std::string::npos) return url;
  const char separator = url.find('?') == std::string::npos ? '?' : '&';
  return fmt::format("{}{}recv_buf_size={}", url, separator, bytes);
}

std::int64_t granted_receive_buffer(std::int64_t asked) {
  // LCM keeps its socket to itself, so another one is asked for the same.
  const int socket_fd = socket(AF_INET, SOCK_DGRAM, 0);
  if (socket_fd < 0) return 0;
  const int wanted = static_cast<int>(asked);
  int granted = 0;
  socklen_t size = sizeof(granted);
  setsockopt(socket_fd, SOL_SOCKET, SO_RCVBUF, &wanted, sizeof(wanted));
  const bool known = getsockopt(socket_fd, SOL_SOCKET, SO_RCVBUF, &granted, &size) == 0;
  close(socket_fd);
  return known ? granted / 2 : 0;  // Linux doubles what was asked for, to pay for its bookkeeping: socket(7)
}

bool force_receive_buffer(int socket, std::int64_t bytes) {
  const int wanted = static_cast<int>(bytes);
  return setsockopt(socket, SOL_SOCKET, SO_RCVBUFFORCE, &wanted, sizeof wanted) == 0;
}

std::int64_t count_dropped_datagrams(int socket) {
  std::array<std::uint32_t, SK_MEMINFO_VARS> counts{};
  socklen_t size = sizeof counts;
  const bool is_known = getsockopt(socket, SOL_SOCKET, SO_MEMINFO, counts.data(), &size) == 0;
  require(is_known && size > SK_MEMINFO_DROPS * sizeof counts[0], "the kernel does not say what it drops: {}",
          std::strerror(errno));
  return counts[SK_MEMINFO_DROPS];
}

bool has_waiting_datagram(int socket) {
  pollfd asked{socket, POLLIN, 0};
  return poll(&asked, 1, 0) > 0 && (asked.revents & POLLIN) != 0;
}

std::int64_t needed_receive_buffer(std::int64_t frame_bytes) {
  constexpr std::int64_t kRawVgaFrame = 640 * 480 * 5;
  return (frame_bytes * kNeededReceiveBuffer + kRawVgaFrame - 1) / kRawVgaFrame;
}

std::string receive_buffer_remedy() {
  return fmt::format("sudo sysctl -w net.core.rmem_max={} net.core.rmem_default={}", kAskedReceiveBuffer,
                     kNeededReceiveBuffer);
}

std::string receive_buffer_advice(std::int64_t granted) {
  if (granted >= kNeededReceiveBuffer) return "";
  return fmt::format("receive buffer of {} kB granted, {} kB needed, or frames are lost silently; mend it with: {}",
                     granted / 1024, kNeededReceiveBuffer / 1024, receive_buffer_remedy());
}

}  // namespace houghstream
