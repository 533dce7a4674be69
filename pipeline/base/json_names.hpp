#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace houghstream {

/// Parses JSON in which no name is duplicate in an object: readers differ in whether they take its first or its last
/// value, and would ignore the other silently. Returns a discarded value where the text is no JSON. Throws InputError,
/// naming `source`, for such a name, and where lists are nested too deep (pipeline/base/files.hpp).
nlohmann::json parse_json(std::string_view text, const std::string& source);

}  // namespace houghstream
