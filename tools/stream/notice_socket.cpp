#include "tools/stream/notice_socket.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <charconv>
#include <cstddef>
#include <string_view>

namespace houghstream::stream {
namespace {

std::optional<std::chrono::microseconds> extension_in(std::string_view words) {
  constexpr std::string_view kKey = "EXTEND_TIMEOUT_USEC=";
  const std::size_t at = words.find(kKey);
  if (at == std::string_view::npos || (at > 0 && words[at - 1] != '\n')) return std::nullopt;
  std::int64_t value = 0;
  const auto [end, fault] = std::from_chars(words.data() + at + kKey.size(), words.data() + words.size(), value);
  constexpr std::int64_t kMaxUs = 60'000'000;  // of one notice
  if (fault != std::errc() || value < 0 || value > kMaxUs) return std::nullopt;
  return std::chrono::microseconds(value);
}

}  // namespace

NoticeSocket::NoticeSocket() : socket_(socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
  if (socket_ < 0) return;
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  // Bound to the family alone, it gets a name of the abstract namespace that nobody has.
  if (bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address.sun_family)) != 0) return;
  socklen_t length = sizeof(address);
  if (getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &length) != 0) return;
  const std::size_t size = length - offsetof(sockaddr_un, sun_path);
  if (size > 1) name_ = "@" + std::string(address.sun_path + 1, size - 1);
}

NoticeSocket::~NoticeSocket() {
  if (socket_ >= 0) close(socket_);
}

std::optional<std::chrono::microseconds> NoticeSocket::extension() {
  std::array<char, 4096> words{};
  std::optional<std::chrono::microseconds> extension;
  constexpr int kMaxNotices = 64;  // who sends without end does not keep us
  ssize_t size = 0;
  for (int i = 0; i < kMaxNotices && socket_ >= 0 && (size = recv(socket_, words.data(), words.size(), 0)) >= 0; ++i) {
    if (const auto asked = extension_in({words.data(), static_cast<std::size_t>(size)})) extension = asked;
  }
  return extension;
}

}  // namespace houghstream::stream
