#include "pipeline/bus/lcm_url.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <cstring>
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

/// What stands between scheme and options.
std::string place_in(const std::string& url, const std::string& scheme) {
  return url.substr(scheme.size(), url.find('?') - scheme.size());
}

std::optional<BusPlace> place_of(const std::string& url, const std::string& scheme, const BusPlace& usual) {
  if (!begins_with(url, scheme)) return std::nullopt;
  const std::string place = place_in(url, scheme);
  const std::size_t colon = place.find(':');
  const std::string address = place.substr(0, colon);
  const std::string port = colon == std::string::npos ? "" : place.substr(colon + 1);
  return BusPlace{address.empty() ? usual.address : address, port.empty() ? usual.port : port};
}

/// 0 to `most`, as people write it: LCM takes 010 for 8 and 0x10 for 16.
bool is_number(const std::string& text, int most) {
  constexpr std::size_t kMostDigits = 10;
  const bool digits = std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
  if (text.empty() || text.size() > kMostDigits || !digits || (text.size() > 1 && text[0] == '0')) return false;
  return std::atoll(text.c_str()) <= most;
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

}  // namespace

std::optional<BusPlace> multicast_group(const std::string& url) {
  return place_of(url, kMulticast, {"239.255.76.67", "7667"});
}

std::optional<BusPlace> tcp_server(const std::string& url) {
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
  require(known, "LCM URL '{}', expected udpm://ADDRESS:PORT?ttl=0, tcpq://ADDRESS:PORT or file://LOG", url);
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

void require_multicast_route(const std::string& url) {
  const std::optional<BusPlace> group = multicast_group(url);
  if (!group) return;
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(std::atoi(group->port.c_str())));
  const int probe = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (probe < 0) return;  // LCM will fare no better, and fail
  const bool has_route = inet_pton(AF_INET, group->address.c_str(), &to.sin_addr) == 1 &&
                         connect(probe, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0;
  const int error = errno;
  close(probe);
  require(has_route, "{}: no multicast route to {} ({}); mend it with: {}", url, group->address, std::strerror(error),
          multicast_route_remedy());
}

std::string multicast_route_remedy() {
  return "sudo ip link set lo multicast on; sudo ip route add 224.0.0.0/4 dev lo";
}

}  // namespace houghstream
