#pragma once

#include <filesystem>
#include <string>

#include "tools/common/command_line.hpp"

// What becomes of a file that has the name of an output which can be made again. A recording, which cannot, takes the
// next number instead (add_replace_option in tool_main.hpp).

namespace houghstream {

/// Adds the option --replace; `outputs` names what it is about.
void add_replace_output_option(CommandLine& line, bool& replace, const std::string& outputs);

/// Throws InputError where an ordinary file has this name and may not be replaced. Devices and pipes are written as
/// they are; an empty name is none. Asked before the work whose result is to go there.
void require_new_output(const std::filesystem::path& file, bool replace);

}  // namespace houghstream
