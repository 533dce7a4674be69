#include "pipeline/base/service_notice.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstddef>
#include <cstdlib>
#include <cstring>

#include "pipeline/base/stop_signal.hpp"

namespace houghstream {

void notify_service(const std::string& words) {
  const char* name = std::getenv("NOTIFY_SOCKET");
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (name == nullptr || (name[0] != '/' && name[0] != '@') || std::strlen(name) >= sizeof(address.sun_path)) return;
  std::memcpy(address.sun_path, name, std::strlen(name));
  if (name[0] == '@') address.sun_path[0] = '\0';  // a name of the abstract namespace
  const int to = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (to < 0) return;
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + std::strlen(name));
  sendto(to, words.data(), words.size(), MSG_NOSIGNAL, reinterpret_cast<const sockaddr*>(&address), length);
  close(to);
}

StillFinishing::StillFinishing(From from) {
  const BlockStopSignals block;
  thread_ = std::thread([this, from] {
    const std::string words =
        "EXTEND_TIMEOUT_USEC=" + std::to_string(std::chrono::microseconds(kExtension).count()) + "\nSTOPPING=1";
    std::unique_lock<std::mutex> lock(mutex_);
    while (!has_ended_ && from == From::kStopSignal && !stop_requested())
      ends_.wait_for(lock, std::chrono::milliseconds(20));
    const auto end = std::chrono::steady_clock::now() + kMaxLength;
    while (!has_ended_ && std::chrono::steady_clock::now() < end) {
      notify_service(words);
      ends_.wait_for(lock, std::chrono::seconds(1));
    }
  });
}

StillFinishing::~StillFinishing() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    has_ended_ = true;
  }
  ends_.notify_one();
  thread_.join();
}

}  // namespace houghstream
