#include "pipeline/bus/own_host.hpp"

#include <linux/filter.h>
#include <linux/if_packet.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <cstdlib>
#include <filesystem>

namespace houghstream {
namespace {

const std::string kMulticast = "udpm://";
const std::string kTcp = "tcpq://";

std::optional<BusPlace> place_of(const std::string& url, const std::string& scheme, const BusPlace& usual) {
  if (url.rfind(scheme, 0) != 0) return std::nullopt;
  const std::string place = url.substr(scheme.size(), url.find('?') - scheme.size());
  const std::size_t colon = place.find(':');
  const std::string address = place.substr(0, colon);
  const std::string port = colon == std::string::npos ? "" : place.substr(colon + 1);
  return BusPlace{address.empty() ? usual.address : address, port.empty() ? usual.port : port};
}

}  // namespace

std::optional<BusPlace> multicast_group(const std::string& url) {
  return place_of(url, kMulticast, {"239.255.76.67", "7667"});
}

std::optional<BusPlace> tcp_server(const std::string& url) {
  return place_of(url, kTcp, {"127.0.0.1", "7700"});
}

bool is_of_own_host(const std::string& url) {
  if (url.rfind(kMulticast, 0) != 0) return false;
  const std::size_t options = url.find('?');
  const std::size_t ttl = options == std::string::npos ? std::string::npos : url.find("ttl=", options);
  return ttl == std::string::npos || std::atoi(url.c_str() + ttl + 4) == 0;
}

std::vector<int> receiving_sockets(const std::string& url) {
  std::vector<int> found;
  const std::optional<BusPlace> group = multicast_group(url);
  if (!group) return found;
  const int port = std::atoi(group->port.c_str());
  std::error_code error;
  for (std::filesystem::directory_iterator entry("/proc/self/fd", error), end; !error && entry != end;
       entry.increment(error)) {
    const int number = std::atoi(entry->path().filename().c_str());
    sockaddr_in address{};
    socklen_t size = sizeof address;
    int type = 0;
    socklen_t type_size = sizeof type;
    const bool is_udp = getsockopt(number, SOL_SOCKET, SO_TYPE, &type, &type_size) == 0 && type == SOCK_DGRAM &&
                        getsockname(number, reinterpret_cast<sockaddr*>(&address), &size) == 0 &&
                        address.sin_family == AF_INET && ntohs(address.sin_port) == port;
    if (is_udp) found.push_back(number);
  }
  return found;
}

bool refuse_other_hosts(int socket) {
  // What this machine sends to a group comes back as PACKET_LOOPBACK, what it sends to itself through the interface lo.
  const auto ancillary = [](int what) { return static_cast<std::uint32_t>(SKF_AD_OFF + what); };
  std::array<sock_filter, 6> program = {{BPF_STMT(BPF_LD | BPF_W | BPF_ABS, ancillary(SKF_AD_PKTTYPE)),
                                         BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, PACKET_LOOPBACK, 3, 0),
                                         BPF_STMT(BPF_LD | BPF_W | BPF_ABS, ancillary(SKF_AD_IFINDEX)),
                                         BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, if_nametoindex("lo"), 1, 0),
                                         BPF_STMT(BPF_RET | BPF_K, 0), BPF_STMT(BPF_RET | BPF_K, 0xFFFFFFFF)}};
  const sock_fprog filter{static_cast<unsigned short>(program.size()), program.data()};
  return setsockopt(socket, SOL_SOCKET, SO_ATTACH_FILTER, &filter, sizeof filter) == 0;
}

}  // namespace houghstream
