#pragma once

#include "tools/doctor/machine.hpp"

// Probes of a Machine that use the bus itself. Neither throws.

namespace houghstream::doctor {

/// Machine::heard_bytes of this machine.
std::size_t heard_bytes(const std::string& url, const std::string& channel);

/// Machine::heard_frame_channels of this machine.
std::set<std::string> heard_frame_channels(const std::string& url);

/// Machine::heard_errors of this machine.
std::map<std::string, std::string> heard_errors(const std::string& url);

/// Machine::self_test of this machine: some messages one after another on a channel of their own.
SelfTest self_test(const std::string& url, std::size_t bytes);

}  // namespace houghstream::doctor
