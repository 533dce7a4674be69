#include "pipeline/bus/lcm_url.hpp"

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <limits>
#include <set>

#include "pipeline/base/checks.hpp"

namespace houghstream {
namespace {

const std::string kMulticast = "udpm://";
const std::string kTcp = "tcpq://";

bool begins_with(const std::string& url, const std::string& scheme) {
  return url.rfind(scheme, 0) == 0;
}

/// Returns the text between scheme and options.
std::string place_in(const std::string& url, const std::string& scheme) {
  return url.substr(scheme.size(), url.find('?') - scheme.size());
}

std::optional<Endpoint> place_of(const std::string& url, const std::string& scheme, const Endpoint& usual) {
  if (!begins_with(url, scheme)) return std::nullopt;
  const std::string place = place_in(url, scheme);
  const std::size_t colon = place.find(':');
  const std::string address = place.substr(0, colon);
  const std::string port = colon == std::string::npos ? "" : place.substr(colon + 1);
  return Endpoint{address.empty() ? usual.address : address, port.empty() ? usual.port : port};
}

/// Returns whether the text is 0 to `maximum` in the form that people write: LCM takes 010 for 8 and 0x10 for 16.
bool is_number(const std::string& text, int maximum) {
  constexpr std::size_t kMaxDigits = 10;
  const bool digits = std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
  if (text.empty() || text.size() > kMaxDigits || !digits || (text.size() > 1 && text[0] == '0')) return false;
  return std::atoll(text.c_str()) <= maximum;
}

void check_group(const std::string& url) {
  const std::string place = place_in(url, kMulticast);
  if (place.empty()) return;
  const std::size_t colon = place.find(':');
  const std::string address = place.substr(0, colon);
  in_addr number{};
  const bool is_group = inet_pton(AF_INET, address.c_str(), &number) == 1 && (ntohl(number.s_addr) >> 28U) == 0xEU;
  require(is_group, "LCM URL {}: '{}' is no multicast group, expected 224.0.0.0 to 239.255.255.255", url, address);
  if (colon == std::string::npos) return;
  const std::string port = place.substr(colon + 1);
  require(is_number(port, 65535) && port != "0", "LCM URL {}: port '{}', expected 1 to 65535", url, port);
}

/// Closes a socket at the end of its scope.
struct Probe {
  explicit Probe(int descriptor) : number(descriptor) {}
  ~Probe() {
    if (number >= 0) close(number);
  }
  Probe(const Probe&) = delete;
  Probe& operator=(const Probe&) = delete;
  int number;
};

/// Returns the remedy for a missing route: with ttl=0 a route through lo suffices; with more the messages are meant for
/// other hosts.
std::string route_remedy(const std::string& url) {
  for (const auto& [name, value] : url_options(url)) {
    if (name == "ttl" && value != "0") return "connect the network, or: sudo ip route add 224.0.0.0/4 dev INTERFACE";
  }
  return multicast_route_remedy();
}

std::string no_route_reason(const std::string& url, const Endpoint& group) {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(std::atoi(group.port.c_str())));
  const Probe probe(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  const bool has_route = probe.number >= 0 && inet_pton(AF_INET, group.address.c_str(), &to.sin_addr) == 1 &&
                         connect(probe.number, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0;
  const std::string fault = std::strerror(errno);
  if (has_route) return "";
  return fmt::format("no multicast route to {} ({}); mend it with: {}", group.address, fault, route_remedy(url));
}

/// Why no connection comes about at this address within a quarter of a second; "" where one does.
std::string connection_fault(const addrinfo& address) {
  constexpr int kTimeout_ms = 250;
  const Probe probe(socket(address.ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (probe.number < 0) return std::strerror(errno);
  if (connect(probe.number, address.ai_addr, address.ai_addrlen) == 0) return "";
  if (errno != EINPROGRESS) return std::strerror(errno);
  pollfd waiting{probe.number, POLLOUT, 0};
  if (poll(&waiting, 1, kTimeout_ms) <= 0) return "it does not answer";
  int fault = 0;
  socklen_t size = sizeof fault;
  if (getsockopt(probe.number, SOL_SOCKET, SO_ERROR, &fault, &size) != 0) fault = errno;
  return fault == 0 ? "" : std::strerror(fault);
}

std::string no_server_reason(const Endpoint& server) {
  addrinfo wanted{};
  wanted.ai_family = AF_INET;  // the family with which LCM connects
  wanted.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int unknown = getaddrinfo(server.address.c_str(), server.port.c_str(), &wanted, &found);
  const std::string fault = unknown != 0 ? gai_strerror(unknown) : connection_fault(*found);
  if (unknown == 0) freeaddrinfo(found);
  if (fault.empty()) return "";
  return fmt::format("not connected to the server at {}:{} ({})", server.address, server.port, fault);
}

}  // namespace

std::optional<Endpoint> parse_multicast_group(const std::string& url) {
  return place_of(url, kMulticast, {"239.255.76.67", "7667"});
}

std::optional<Endpoint> parse_tcp_server(const std::string& url) {
  return place_of(url, kTcp, {"127.0.0.1", "7700"});
}

std::vector<std::pair<std::string, std::string>> url_options(const std::string& url) {
  std::vector<std::pair<std::string, std::string>> options;
  std::size_t at = url.find('?');
  while (at < url.size()) {
    const std::size_t end = std::min(url.find_first_of("&,", at + 1), url.size());
    const std::string option = url.substr(at + 1, end - at - 1);
    const std::size_t equals = std::min(option.find('='), option.size());
    const std::string value = equals < option.size() ? option.substr(equals + 1) : "";
    if (!option.empty()) options.emplace_back(option.substr(0, equals), value);
    at = end;
  }
  return options;
}

void check_lcm_url(const std::string& url) {
  const std::vector<std::string> schemes = {kMulticast, kTcp, "file://", "memq://", "mpudpm://"};
  const bool known =
      std::any_of(schemes.begin(), schemes.end(), [&](const std::string& scheme) { return begins_with(url, scheme); });
  std::error_code unknown;
  require(known, "LCM URL '{}', expected udpm://ADDRESS:PORT?ttl=0, tcpq://ADDRESS:PORT or file://LOG{}", url,
          std::filesystem::is_regular_file(url, unknown) ? "; did you mean file://" + url + "?" : "");
  if (!begins_with(url, kMulticast)) return;
  check_group(url);
  std::set<std::string> names;
  for (const auto& [name, value] : url_options(url)) {
    require(names.insert(name).second, "LCM URL {}: '{}' stands there twice", url, name);
    require(name != "ttl" || is_number(value, 255), "LCM URL {}: ttl '{}', expected 0 to 255", url, value);
    require(name != "recv_buf_size" || is_number(value, std::numeric_limits<int>::max()),
            "LCM URL {}: recv_buf_size '{}', expected bytes", url, value);
  }
}

std::string unknown_options_advice(const std::string& url) {
  const bool multicast = begins_with(url, kMulticast);
  if (!multicast && !begins_with(url, kTcp)) return "";
  for (const auto& [name, value] : url_options(url)) {
    if (multicast && (name == "ttl" || name == "recv_buf_size")) continue;
    return fmt::format("LCM URL {}: LCM passes over '{}', {}", url, name,
                       multicast ? "it knows ttl and recv_buf_size" : "of tcpq it knows no options");
  }
  return "";
}

std::string unreachable_reason(const std::string& url) {
  if (const std::optional<Endpoint> group = parse_multicast_group(url)) return no_route_reason(url, *group);
  if (const std::optional<Endpoint> server = parse_tcp_server(url)) return no_server_reason(*server);
  return "";
}

std::string multicast_route_remedy() {
  return "sudo ip link set lo multicast on; sudo ip route add 224.0.0.0/4 dev lo";
}

}  // namespace houghstream
