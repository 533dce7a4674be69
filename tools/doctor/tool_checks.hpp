#pragma once

#include <filesystem>

#include "tools/doctor/finding.hpp"
#include "tools/doctor/machine.hpp"

namespace houghstream::doctor {

/// Processor, LCM's tools, Java and what lcm-spy needs of it, display. All of it is convenience: notes, never wrong.
/// `types_jar`: our message types for Java.
Findings check_tools(const Machine& machine, const std::filesystem::path& types_jar);

}  // namespace houghstream::doctor
