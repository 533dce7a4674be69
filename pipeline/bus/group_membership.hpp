#pragma once

#include <string>

namespace houghstream {

/// Joins the multicast group on the interface that the route to the group leads through now, unless the socket has
/// joined it there before. LCM joins once, when it opens its socket: a membership goes with its interface (a WLAN stick
/// that is pulled out), and is of no use once the route leads through another one. Returns false where the kernel
/// refuses.
bool join_group(int socket, const std::string& address);

}  // namespace houghstream
