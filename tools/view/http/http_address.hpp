#pragma once

#include <optional>
#include <string>
#include <vector>

namespace houghstream::view {

/// Gives the address of hs-view's page, or of its server for Foxglove.
struct HttpAddress {
  std::string host = "127.0.0.1";  ///< a name or an address, IPv6 without brackets
  int port = 0;                    ///< 0 = any that is free
  /// Further names that the page answers to, in lower case: of a proxy before it, or of this machine in a DNS.
  std::vector<std::string> names;
};

/// Parses "[ADDRESS:]PORT", an IPv6 address in brackets. Throws InputError that names the option.
HttpAddress parse_http_address(const std::string& text, const std::string& option = "--http");

/// Returns whether only programs of this machine reach it: 127.x.x.x, ::1 and localhost.
bool is_local(const std::string& host);

/// Checks a name of `--http-host` and returns it in lower case. Throws InputError.
std::string parse_host_name(const std::string& text);

/// Returns the host of a request's Host header ("NAME[:PORT]" or "[IPV6][:PORT]") in lower case, without brackets, port
/// and the dot of a full name; nothing where the header is anything else.
std::optional<std::string> parse_host_header(const std::string& header);

/// Returns whether a page at this address answers requests with this Host header. A website that has its own name
/// resolved to a robot's address (DNS rebinding) cannot choose the header: the browser sends the website's name. So it
/// accepts the names that the page was started for, and this machine's; "localhost", which browsers resolve themselves;
/// and addresses, which nobody resolves. A page for this machine answers to its loopback addresses only.
bool answers_to(const HttpAddress& address, const std::string& host_header);

/// Returns the name of this machine as in the printed address; "" where it has none.
std::string machine_name();

/// Returns this machine's addresses that others reach a listener at `host` by: those of all its links for 0.0.0.0 and
/// ::, IPv6 for the latter too, without loopback and addresses of a single link; none for another host.
std::vector<std::string> network_addresses(const std::string& host);

/// Returns the reason why listening there is impossible, in words; "" where it is possible.
std::string listening_problem(const HttpAddress& address);

}  // namespace houghstream::view
