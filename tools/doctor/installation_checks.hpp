#pragma once

#include <filesystem>

#include "tools/doctor/finding.hpp"
#include "tools/doctor/machine.hpp"

namespace houghstream::doctor {

/// Processor, LCM's tools, Java and what lcm-spy needs of it, display. All of it is convenience: notes, never wrong.
/// `types_jar`: our message types for Java.
Findings check_tools(const Machine& machine, const std::filesystem::path& types_jar);

/// Whether another installation, an old one perhaps, lies beside this one, whose programs are in the folder `programs`:
/// on $PATH, or where Debian's Python looks for packages; and what our Python package needs. Notes, never wrong.
Findings check_installation(const Machine& machine, const std::filesystem::path& programs);

}  // namespace houghstream::doctor
