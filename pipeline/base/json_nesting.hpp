#pragma once

#include <string>
#include <string_view>

namespace houghstream {

/// Throws InputError where the JSON holds lists or objects within one another more than 64 times: who reads, copies or
/// prints it goes down as deep as it goes. Asked before it is parsed; whether it is JSON is not.
void check_json_nesting(std::string_view text, const std::string& source);

}  // namespace houghstream
