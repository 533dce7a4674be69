#pragma once

#include <string>

namespace houghstream::view {

/// Where hs-view's page is served.
struct HttpAddress {
  std::string host = "127.0.0.1";  ///< a name or an address, IPv6 without brackets
  int port = 0;                    ///< 0 = any that is free
};

/// Parses "[ADDRESS:]PORT", an IPv6 address in brackets. Throws InputError.
HttpAddress parse_http_address(const std::string& text);

/// Whether only programs of this machine reach it: 127.x.x.x, ::1 and localhost.
bool is_local(const std::string& host);

/// Whether a request's Host header ("NAME[:PORT]") names this machine itself: then no page from elsewhere has reached
/// here by a name that it made up.
bool names_this_machine(const std::string& host_header);

/// Why nobody can listen there, in words; "" where it can be done.
std::string listening_problem(const HttpAddress& address);

}  // namespace houghstream::view
