#pragma once

#include <cstddef>
#include <string>

#include "tools/doctor/finding.hpp"
#include "tools/doctor/machine.hpp"

namespace houghstream::doctor {

struct BusSettings {
  std::string url;            ///< complete LCM URL
  std::string frame_channel;  ///< listened to for the size of the frames in use
  std::size_t frame_bytes;    ///< taken where no frame is heard
};

/// Checks the URL; then the multicast route, receive buffers for the frames in use and for Java, the permitted senders,
/// a loopback of messages of that size, the channels of frames where none arrives on the subscribed one, and errors of
/// processes on the bus.
Findings check_network(const Machine& machine, const BusSettings& settings);

}  // namespace houghstream::doctor
