#pragma once

#include <cstddef>
#include <string>

#include "tools/doctor/finding.hpp"
#include "tools/doctor/machine.hpp"

namespace houghstream::doctor {

struct BusSettings {
  std::string url;            ///< as LCM takes it, complete
  std::string frame_channel;  ///< listened to for the size of the frames in use
  std::size_t frame_bytes;    ///< taken where no frame is heard
};

/// What is wrong with the URL; or multicast route, receive buffers for the frames in use and for Java, who may send,
/// messages of that size sent and received, on which channels frames come where none comes on the one that is listened
/// to, and what processes on the bus complain of.
Findings check_network(const Machine& machine, const BusSettings& settings);

}  // namespace houghstream::doctor
