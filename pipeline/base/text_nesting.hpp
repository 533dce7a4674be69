#pragma once

#include <string>
#include <string_view>

// What a text holds within one another, asked before it is parsed; whether it is JSON or YAML is not.

namespace houghstream {

/// Throws InputError where the JSON holds lists or objects within one another more than 64 times: who reads, copies or
/// prints it goes down as deep as it goes.
void check_json_nesting(std::string_view text, const std::string& source);

/// Throws InputError for YAML that OpenCV's reader would go down into too deep: it takes 5 kB of the stack for each
/// level. A level takes a bracket, or begins further to the right than the one above it, so that brackets and the
/// length of lines are what is limited, and the length of all.
void check_yaml_nesting(std::string_view text, const std::string& source);

}  // namespace houghstream
