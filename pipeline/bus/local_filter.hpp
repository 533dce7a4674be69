#pragma once

#include <string>
#include <vector>

namespace houghstream {

/// Returns whether an LCM URL is of multicast that stays on this machine: udpm with ttl=0, which is also LCM's default.
bool is_host_local(const std::string& url);

/// LCM listens at the group's port on all of the machine's addresses, so that a host on the network reaches it by plain
/// UDP, whatever the ttl. These two keep others out: what does not come from this machine is dropped by the kernel
/// (socket(7), SO_ATTACH_FILTER), before it reaches the process.

/// Sockets of this process that receive UDP at the port of a udpm URL; none for other URLs.
std::vector<int> find_receive_sockets(const std::string& url);

/// Makes the socket accept only datagrams of this machine from now on. Returns false where the kernel refuses.
bool attach_local_filter(int socket);

}  // namespace houghstream
