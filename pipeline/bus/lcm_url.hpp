#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace houghstream {

/// Gives the endpoint of an LCM URL, with LCM's defaults where it states none.
struct Endpoint {
  std::string address;
  std::string port;
};

/// Returns the group of udpm://ADDRESS:PORT?...; nothing for other URLs.
std::optional<Endpoint> parse_multicast_group(const std::string& url);

/// Returns the server of tcpq://ADDRESS:PORT?...; nothing for other URLs.
std::optional<Endpoint> parse_tcp_server(const std::string& url);

/// Returns name and value of each option behind the '?' of a URL.
std::vector<std::pair<std::string, std::string>> url_options(const std::string& url);

/// Throws InputError unless LCM understands the URL: a scheme that it has, and of udpm a multicast group, a port, a ttl
/// and a receive buffer that are such. What it does not understand LCM itself passes over, or takes for a number.
void check_lcm_url(const std::string& url);

/// Returns one line about options of a network's URL that LCM does not know; "" where there are none.
std::string unknown_options_advice(const std::string& url);

/// Returns why this machine cannot send to the group of a udpm URL, or to the server of a tcpq URL, and the remedy; ""
/// where it can, and for other URLs. LCM checks the same for multicast, and reports it in fifteen lines with a random
/// address. A server that does not answer is waited for a quarter of a second.
std::string unreachable_reason(const std::string& url);

/// The command that makes a route for multicast within this machine, until its next start.
std::string multicast_route_remedy();

}  // namespace houghstream
