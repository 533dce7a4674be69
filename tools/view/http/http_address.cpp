#include "tools/view/http/http_address.hpp"

#include <fmt/format.h>
#include <netdb.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <memory>

#include "pipeline/base/checks.hpp"

namespace houghstream::view {
namespace {

bool all_digits(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

}  // namespace

HttpAddress parse_http_address(const std::string& text) {
  const std::string expected = "expected [ADDRESS:]PORT, for instance 8080, 0.0.0.0:8080 or [::1]:8080";
  HttpAddress address;
  const std::size_t colon = text.rfind(':');
  const std::string port = colon == std::string::npos ? text : text.substr(colon + 1);
  if (colon != std::string::npos) address.host = text.substr(0, colon);
  require(all_digits(port) && port.size() <= 5, "--http {}: '{}' is no port, {}", text, port, expected);
  address.port = std::stoi(port);
  require(address.port <= 65535, "--http {}: port {}, expected at most 65535", text, port);
  const bool in_brackets = address.host.size() > 2 && address.host.front() == '[' && address.host.back() == ']';
  if (in_brackets) address.host = address.host.substr(1, address.host.size() - 2);
  const bool bare = !in_brackets && address.host.find(':') != std::string::npos;
  require(!address.host.empty() && !bare && address.host.find('/') == std::string::npos,
          "--http {}: '{}' is no address, {}", text, address.host, expected);
  return address;
}

bool is_local(const std::string& host) {
  const bool loopback = host.rfind("127.", 0) == 0 && std::all_of(host.begin(), host.end(), [](unsigned char c) {
                          return c == '.' || std::isdigit(c);
                        });
  return loopback || host == "localhost" || host == "::1";
}

bool names_this_machine(const std::string& host_header) {
  if (host_header.rfind("[::1]", 0) == 0) return true;
  return is_local(host_header.substr(0, host_header.find(':')));
}

std::string listening_problem(const HttpAddress& address) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_PASSIVE;
  addrinfo* found = nullptr;
  const int refusal = getaddrinfo(address.host.c_str(), std::to_string(address.port).c_str(), &hints, &found);
  if (refusal != 0) return fmt::format("'{}' is no address ({})", address.host, gai_strerror(refusal));
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> owned(found, freeaddrinfo);
  int problem = 0;
  for (const addrinfo* info = found; info != nullptr; info = info->ai_next) {
    const int opened = socket(info->ai_family, info->ai_socktype, info->ai_protocol);
    if (opened < 0) continue;
    const int yes = 1;
    setsockopt(opened, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
    const bool bound = bind(opened, info->ai_addr, info->ai_addrlen) == 0 && listen(opened, 1) == 0;
    problem = bound ? 0 : errno;
    close(opened);
    if (bound) return "";
  }
  if (problem == EADDRINUSE) return fmt::format("port {} is taken by another program", address.port);
  if (problem == EACCES) return fmt::format("port {} is root's, expected 1024 or above", address.port);
  if (problem == EADDRNOTAVAIL) return fmt::format("this machine has no address {}", address.host);
  return fmt::format("{}", std::strerror(problem));
}

}  // namespace houghstream::view
