#include "tools/doctor/network_checks.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <sstream>
#include <tuple>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/printable.hpp"
#include "pipeline/bus/frame_silence.hpp"
#include "pipeline/bus/lcm_url.hpp"
#include "pipeline/bus/local_filter.hpp"
#include "pipeline/bus/receive_buffer.hpp"

namespace houghstream::doctor {
namespace {

constexpr const char* kRoute = "multicast route";
constexpr const char* kBuffer = "receive buffer";
constexpr const char* kJavaBuffer = "Java's buffer";
constexpr const char* kSenders = "who may send";
constexpr const char* kFrames = "frames";
constexpr const char* kColours = "colours";
constexpr const char* kTiming = "timing";
constexpr const char* kSelfTest = "LCM self test";
constexpr const char* kBus = "the bus";

/// Returns untrusted text off the wire, shortened and printable.
std::string off_the_wire(const std::string& text) {
  constexpr std::size_t kMaxLength = 300;
  return printable(text.substr(0, kMaxLength));
}

std::string server_remedy(const Endpoint& server) {
  const bool is_here = server.address == "127.0.0.1" || server.address == "localhost";
  return fmt::format("{}java -cp /usr/share/java/lcm.jar lcm.lcm.TCPService {}",
                     is_here ? "" : fmt::format("on {}: ", server.address), server.port);
}

/// Returns the interface through which packets to the address leave, by /proc/net/route: the narrowest route, then the
/// smallest metric. Numbers there are in the order of the network, read as those of this machine, like inet_addr().
std::optional<std::string> interface_to(const Machine& machine, const std::string& address) {
  const std::uint32_t target = inet_addr(address.c_str());
  std::optional<std::tuple<std::uint32_t, std::int64_t, std::string>> best;
  std::istringstream lines(machine.read("proc/net/route"));
  std::string line;
  std::getline(lines, line);  // names of the columns
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    std::string name;
    std::uint32_t destination = 0;
    std::uint32_t gateway = 0;
    std::uint32_t flags = 0;
    std::string counts[2];
    std::int64_t metric = 0;
    std::uint32_t mask = 0;
    words >> name >> std::hex >> destination >> gateway >> flags >> counts[0] >> counts[1] >> std::dec >> metric >>
        std::hex >> mask;
    constexpr std::uint32_t kUp = 0x1;
    constexpr std::uint32_t kReject = 0x200;
    if (!words || (flags & (kUp | kReject)) != kUp || (target & mask) != destination) continue;
    const auto candidate = std::make_tuple(ntohl(mask), -metric, name);
    if (!best || candidate > *best) best = candidate;
  }
  return best ? std::optional<std::string>(std::get<2>(*best)) : std::nullopt;
}

/// Checks whether a stream can run at the URL.
Finding check_url(const std::string& url) {
  const std::string remedy = "export LCM_DEFAULT_URL='udpm://239.255.76.67:7667?ttl=0', and no -l";
  if (url.rfind("file://", 0) == 0) return wrong(kBus, fmt::format("{} is a log, expected a network", url), remedy);
  try {
    check_lcm_url(url);
  } catch (const InputError& error) {
    return wrong(kBus, error.what(), remedy);
  }
  const std::string unknown = unknown_options_advice(url);
  return unknown.empty() ? ok(kBus, url) : note(kBus, unknown);
}

Finding check_route(const Machine& machine, const std::string& url) {
  const std::optional<Endpoint> group = parse_multicast_group(url);
  if (!group) return ok(kRoute, fmt::format("not needed with {}", url));
  const std::optional<std::string> name = interface_to(machine, group->address);
  if (!name)
    return wrong(kRoute, fmt::format("no route to {}: LCM cannot send", group->address), multicast_route_remedy());
  return ok(kRoute, fmt::format("{} goes through {}", group->address, *name));
}

Finding check_buffer(const Machine& machine, std::size_t frame_bytes, bool heard) {
  const std::int64_t needed = needed_receive_buffer(static_cast<std::int64_t>(frame_bytes));
  const std::int64_t granted = machine.granted_receive_buffer(std::max(kAskedReceiveBuffer, needed));
  const std::string frames =
      fmt::format("frames of {} kB ({})", frame_bytes / 1000, heard ? "heard on the bus" : "none heard, so assumed");
  if (granted >= needed) return ok(kBuffer, fmt::format("{} kB granted for {}", granted / 1024, frames));
  const std::string what = fmt::format("{} kB granted, {} kB needed for {}: frames are lost without a word",
                                       granted / 1024, needed / 1024, frames);
  if (needed <= kAskedReceiveBuffer) return wrong(kBuffer, what, receive_buffer_remedy());
  return wrong(kBuffer, what, fmt::format("sudo sysctl -w net.core.rmem_max={0} net.core.rmem_default={0}", needed));
}

Finding check_java_buffer(const Machine& machine, std::size_t frame_bytes) {
  const std::int64_t given = std::atoll(machine.read("proc/sys/net/core/rmem_default").c_str());
  if (given >= needed_receive_buffer(static_cast<std::int64_t>(frame_bytes))) {
    return ok(kJavaBuffer, fmt::format("net.core.rmem_default is {} kB", given / 1024));
  }
  return note(kJavaBuffer,
              fmt::format("net.core.rmem_default is {} kB: lcm-spy, lcm-logger and other programs that ask for no more "
                          "lose most frames of {} kB",
                          given / 1024, frame_bytes / 1000),
              receive_buffer_remedy());
}

Finding check_self_test(const Machine& machine, const std::string& url, std::size_t bytes) {
  const SelfTest test = machine.self_test(url, bytes);
  const std::optional<Endpoint> group = parse_multicast_group(url);
  const std::optional<Endpoint> server = parse_tcp_server(url);
  const std::string firewall =
      group    ? fmt::format("sudo iptables -I INPUT -p udp -d {} --dport {} -j ACCEPT", group->address, group->port)
      : server ? fmt::format("sudo iptables -I INPUT -p tcp --dport {} -j ACCEPT", server->port)
               : "";
  if (!test.error.empty())
    return wrong(kSelfTest, test.error, server ? server_remedy(*server) : multicast_route_remedy());
  const std::string what = fmt::format("{} of {} messages of {} kB came back", test.received, test.sent, bytes / 1000);
  if (test.received == test.sent) return ok(kSelfTest, what);
  if (test.received == 0) return wrong(kSelfTest, what + "; is there a firewall?", firewall);
  return wrong(kSelfTest, what + "; the machine is overloaded or its buffers are too small", receive_buffer_remedy());
}

/// Reports errors of processes on the bus: two cameras with inconsistent extrinsics make a wrong world.
Findings check_processes(const Machine& machine, const std::string& url) {
  Findings findings;
  for (const auto& [process, error] : machine.heard_errors(url)) {
    const bool contradiction = process == "hs-track" && error.find("one of their places is wrong") != std::string::npos;
    findings.push_back(contradiction
                           ? wrong(process, off_the_wire(error), "hs-track --check -c CAMERAS, and correct --cameras")
                           : note(off_the_wire(process), "says: " + off_the_wire(error)));
  }
  return findings;
}

/// Reports how cameras render known colours, where hs-pose has learnt it. Detection corrects for it, but colours that a
/// camera cannot separate remain indistinguishable.
Findings check_camera_colours(const Machine& machine, const std::string& url) {
  constexpr double kMinObjects = 2.5;  // chosen: one or two may be wrong
  constexpr double kMaxCast = 15.0;    // chosen: half of the chroma of household objects in the mean
  constexpr double kMinSaturation = 0.5;
  constexpr double kMaxSaturation = 1.8;
  Findings findings;
  for (const CameraChroma& camera : machine.heard_camera_colours(url)) {
    const ChromaMap map = fit_chroma_map(camera.objects);
    const std::string what = fmt::format("{}: {}", off_the_wire(camera.frame.channel), describe(map));
    const bool is_off =
        map.white().norm() > kMaxCast || map.saturation() < kMinSaturation || map.saturation() > kMaxSaturation;
    findings.push_back(
        is_off && map.objects() >= kMinObjects
            ? note(kColours, what + ": set white balance and exposure by hand, in the light of the place")
            : ok(kColours, what));
  }
  return findings;
}

/// Reports by how much cameras take depth later or earlier than colours, where hs-pose --follow has learnt it: it
/// allows for as much, but what moves fast is measured less exactly by two images of two times.
Findings check_camera_timing(const Machine& machine, const std::string& url) {
  constexpr double kMaxLag = 0.005;  // chosen: 2 mm at half a metre a second, a pose's own error
  Findings findings;
  for (const CameraTiming& camera : machine.heard_camera_timings(url)) {
    const double lag_ms = 1e3 * camera.depth_lag_s;
    const std::string what =
        fmt::format("{}: depth is {:.0f} ms {} than colours, give or take {:.0f}", off_the_wire(camera.frame.channel),
                    std::abs(lag_ms), lag_ms < 0.0 ? "older" : "later", 2e3 * camera.sigma_s);
    const bool is_apart = std::abs(camera.depth_lag_s) > kMaxLag + 2.0 * camera.sigma_s;
    findings.push_back(is_apart ? note(kTiming, what + ": let the driver synchronise its images, where it can")
                                : ok(kTiming, what));
  }
  return findings;
}

/// Checks whether frames arrive on another channel than the one that is subscribed.
Findings check_channel(const Machine& machine, const BusSettings& settings) {
  const std::set<std::string> channels = machine.heard_frame_channels(settings.url);
  if (channels.empty()) return {};
  return {note(kFrames, frames_elsewhere(settings.frame_channel, channels),
               fmt::format("hs-detect -c {0}, and so hs-pose, hs-view, hs-track and hs-stream",
                           off_the_wire(*channels.begin())))};
}

/// Interfaces that lead to other hosts.
bool has_neighbours(const Machine& machine) {
  std::istringstream lines(machine.read("proc/net/route"));
  std::string line;
  std::getline(lines, line);  // names of the columns
  while (std::getline(lines, line)) {
    if (!line.empty() && line.rfind("lo\t", 0) != 0) return true;
  }
  return false;
}

/// Checks which hosts may send on the bus, since LCM has no authentication.
Finding check_senders(const Machine& machine, const std::string& url) {
  const std::optional<Endpoint> server = parse_tcp_server(url);
  const std::optional<Endpoint> place = server ? server : parse_multicast_group(url);
  if (!place) return ok(kSenders, fmt::format("this machine only, with {}", url));
  if (!has_neighbours(machine)) return ok(kSenders, "this machine only: no other is connected");
  const std::string drop = fmt::format(
      "sudo nft add table inet houghstream; sudo nft add chain inet houghstream input '{{ type filter hook input "
      "priority 0; }}'; sudo nft add rule inet houghstream input iifname != lo {} dport {} drop",
      server ? "tcp" : "udp", place->port);
  if (machine.refuses_others(place->port)) return ok(kSenders, "this machine only: nftables drops what others send");
  if (server) return note(kSenders, "every host that reaches the server's port may send, and read what is sent", drop);
  if (is_host_local(url))
    return note(kSenders,
                "ttl=0: our programs take what this machine sends only; lcm-spy, lcm-logger and other programs take "
                "what any host sends to this port, unless a firewall drops it",
                drop);
  return note(kSenders,
              "ttl above 0: every host on the network may send, and nobody is asked who he is: a network of "
              "its own for the robot, or a firewall that knows its hosts");
}

}  // namespace

Findings check_network(const Machine& machine, const BusSettings& settings) {
  const Finding bus = check_url(settings.url);
  if (bus.level == Finding::Level::kWrong) return {bus};
  Findings findings;
  if (bus.level == Finding::Level::kNote) findings.push_back(bus);
  findings.push_back(check_route(machine, settings.url));
  const bool route = findings.back().level == Finding::Level::kOk;
  const std::size_t heard = route ? machine.heard_bytes(settings.url, settings.frame_channel) : 0;
  const std::size_t frame_bytes = heard > 0 ? heard : settings.frame_bytes;
  if (parse_multicast_group(settings.url)) {
    findings.push_back(check_buffer(machine, frame_bytes, heard > 0));
    findings.push_back(check_java_buffer(machine, frame_bytes));
  }
  findings.push_back(check_senders(machine, settings.url));
  // Without a route LCM would wait ten seconds for its own test, which fails for the same reason.
  findings.push_back(route ? check_self_test(machine, settings.url, frame_bytes)
                           : note(kSelfTest, "not tried: there is no route"));
  if (!route) return findings;
  if (heard == 0) {
    for (const Finding& finding : check_channel(machine, settings)) findings.push_back(finding);
  }
  for (const Finding& finding : check_processes(machine, settings.url)) findings.push_back(finding);
  if (heard == 0) return findings;
  for (const Finding& finding : check_camera_colours(machine, settings.url)) findings.push_back(finding);
  for (const Finding& finding : check_camera_timing(machine, settings.url)) findings.push_back(finding);
  return findings;
}

}  // namespace houghstream::doctor
