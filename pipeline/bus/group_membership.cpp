#include "pipeline/bus/group_membership.hpp"

#include <arpa/inet.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>

namespace houghstream {
namespace {

bool change(int socket, int what, const ip_mreqn& membership) {
  return setsockopt(socket, IPPROTO_IP, what, &membership, sizeof membership) == 0;
}

/// Memberships on interfaces that are gone still count among the few that the kernel allows for a socket.
void leave_lost_interfaces(int socket, ip_mreqn membership) {
  constexpr int kMaxInterfaces = 4096;
  std::array<char, IF_NAMESIZE> name{};
  for (membership.imr_ifindex = 1; membership.imr_ifindex <= kMaxInterfaces; ++membership.imr_ifindex) {
    if (if_indextoname(static_cast<unsigned>(membership.imr_ifindex), name.data()) == nullptr)
      change(socket, IP_DROP_MEMBERSHIP, membership);
  }
}

}  // namespace

bool join_group(int socket, const std::string& address) {
  ip_mreqn membership{};
  if (inet_pton(AF_INET, address.c_str(), &membership.imr_multiaddr) != 1) return false;
  if (change(socket, IP_ADD_MEMBERSHIP, membership) || errno == EADDRINUSE) return true;
  if (errno != ENOBUFS) return false;
  leave_lost_interfaces(socket, membership);
  return change(socket, IP_ADD_MEMBERSHIP, membership);
}

}  // namespace houghstream
