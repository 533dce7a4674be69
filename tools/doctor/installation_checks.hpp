#pragma once

#include <filesystem>

#include "tools/doctor/finding.hpp"
#include "tools/doctor/machine.hpp"

namespace houghstream::doctor {

/// Checks processor, LCM's tools, Java and lcm-spy's needs of it, display. All of it is optional: notes, never wrong.
/// `types_jar` holds our message types for Java.
Findings check_tools(const Machine& machine, const std::filesystem::path& types_jar);

/// Checks for another installation, perhaps an old one, beside this one, whose programs are in the folder `programs`:
/// on $PATH, or where Debian's Python looks for packages; and for the requirements of the Python package. The findings
/// are notes, never wrong.
Findings check_installation(const Machine& machine, const std::filesystem::path& programs);

}  // namespace houghstream::doctor
