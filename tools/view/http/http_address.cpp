#include "tools/view/http/http_address.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <memory>

#include "pipeline/base/checks.hpp"
#include "tools/common/usage_error.hpp"

namespace houghstream::view {
namespace {

bool all_digits(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

std::string to_lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

bool is_name(const std::string& text) {
  constexpr std::size_t kMaxLength = 253;
  return !text.empty() && text.size() <= kMaxLength && text != "." &&
         std::all_of(text.begin(), text.end(),
                     [](unsigned char c) { return std::isalnum(c) != 0 || c == '.' || c == '-' || c == '_'; });
}

bool is_port(const std::string& text) {
  return all_digits(text) && text.size() <= 5;
}

bool is_ipv4(const std::string& host) {
  in_addr parsed{};
  return inet_pton(AF_INET, host.c_str(), &parsed) == 1;
}

bool is_ipv6(const std::string& host) {
  in6_addr parsed{};
  return inet_pton(AF_INET6, host.c_str(), &parsed) == 1;
}

}  // namespace

HttpAddress parse_http_address(const std::string& text, const std::string& option) {
  const std::string expected = "expected [ADDRESS:]PORT, for instance 8080, 0.0.0.0:8080 or [::1]:8080";
  HttpAddress address;
  const std::size_t colon = text.rfind(':');
  const std::string port = colon == std::string::npos ? text : text.substr(colon + 1);
  if (colon != std::string::npos) address.host = text.substr(0, colon);
  require_usage(is_port(port), "{} {}: '{}' is no port, {}", option, text, port, expected);
  address.port = std::stoi(port);
  require_usage(address.port <= 65535, "{} {}: port {}, expected at most 65535", option, text, port);
  const bool in_brackets = address.host.size() > 2 && address.host.front() == '[' && address.host.back() == ']';
  if (in_brackets) address.host = address.host.substr(1, address.host.size() - 2);
  const bool bare = !in_brackets && address.host.find(':') != std::string::npos;
  require_usage(!address.host.empty() && !bare && address.host.find('/') == std::string::npos,
                "{} {}: '{}' is no address, {}", option, text, address.host, expected);
  return address;
}

bool is_local(const std::string& host) {
  const bool loopback = host.rfind("127.", 0) == 0 && std::all_of(host.begin(), host.end(), [](unsigned char c) {
                          return c == '.' || std::isdigit(c);
                        });
  return loopback || host == "localhost" || host == "::1";
}

std::string parse_host_name(const std::string& text) {
  require_usage(is_name(text), "--http-host {}: expected a name without scheme and port, for instance robot.example",
                text);
  return to_lower(text);
}

std::optional<std::string> parse_host_header(const std::string& header) {
  const bool bracketed = !header.empty() && header.front() == '[';
  const std::size_t end = std::min(bracketed ? header.find(']') : header.find(':'), header.size());
  const std::string rest = header.substr(bracketed ? std::min(end + 1, header.size()) : end);
  if (!rest.empty() && (rest.front() != ':' || !is_port(rest.substr(1)))) return std::nullopt;
  if (bracketed) {
    const std::string host = to_lower(header.substr(1, end - 1));
    const bool whole = end < header.size() && is_ipv6(host);
    return whole ? std::optional(host) : std::nullopt;
  }
  std::string host = to_lower(header.substr(0, end));
  if (!is_name(host)) return std::nullopt;
  if (host.back() == '.') host.pop_back();
  return host;
}

bool answers_to(const HttpAddress& address, const std::string& host_header) {
  const std::optional<std::string> host = parse_host_header(host_header);
  if (!host) return false;
  const auto& names = address.names;
  if (std::find(names.begin(), names.end(), *host) != names.end()) return true;
  if (*host == "localhost" || (is_local(*host) && (is_ipv4(*host) || is_ipv6(*host)))) return true;
  if (is_local(address.host)) return false;
  const std::string machine = to_lower(machine_name());
  return is_ipv4(*host) || is_ipv6(*host) || *host == to_lower(address.host) || (!machine.empty() && *host == machine);
}

std::string machine_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

std::vector<std::string> network_addresses(const std::string& host) {
  std::vector<std::string> addresses;
  ifaddrs* first = nullptr;
  if ((host != "0.0.0.0" && host != "::") || getifaddrs(&first) != 0) return addresses;
  const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> owned(first, freeifaddrs);
  for (const ifaddrs* link = first; link != nullptr; link = link->ifa_next) {
    const bool is_up = (link->ifa_flags & IFF_UP) != 0 && (link->ifa_flags & IFF_LOOPBACK) == 0;
    if (!is_up || link->ifa_addr == nullptr) continue;
    std::array<char, INET6_ADDRSTRLEN> text{};
    const void* bytes = nullptr;
    if (link->ifa_addr->sa_family == AF_INET) {
      bytes = &reinterpret_cast<const sockaddr_in*>(link->ifa_addr)->sin_addr;
    } else if (link->ifa_addr->sa_family == AF_INET6 && host == "::") {
      const in6_addr& address = reinterpret_cast<const sockaddr_in6*>(link->ifa_addr)->sin6_addr;
      if (!IN6_IS_ADDR_LINKLOCAL(&address)) bytes = &address;
    }
    if (bytes != nullptr && inet_ntop(link->ifa_addr->sa_family, bytes, text.data(), text.size()) != nullptr)
      addresses.emplace_back(text.data());
  }
  return addresses;
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
