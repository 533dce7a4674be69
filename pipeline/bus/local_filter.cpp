#include "pipeline/bus/local_filter.hpp"

#include <linux/filter.h>
#include <linux/if_packet.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <optional>

#include "pipeline/bus/lcm_url.hpp"

namespace houghstream {

bool is_host_local(const std::string& url) {
  if (!parse_multicast_group(url)) return false;
  for (const auto& [name, value] : url_options(url)) {
    if (name == "ttl" && std::atoi(value.c_str()) > 0) return false;
  }
  return true;
}

std::vector<int> find_receive_sockets(const std::string& url) {
  std::vector<int> found;
  const std::optional<Endpoint> group = parse_multicast_group(url);
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

bool attach_local_filter(int socket) {
  // Packets that this machine sends to a group come back as PACKET_LOOPBACK, packets that it sends to itself through
  // the interface lo.
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
