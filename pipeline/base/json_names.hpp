#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace houghstream {

/// JSON in which no name stands twice in an object: one reader takes its first value, another its last, and what has
/// the other one is left out without a word. Discarded where the text is no JSON. Throws InputError, naming `source`,
/// for such a name, and where lists lie within one another too deep (pipeline/base/files.hpp).
nlohmann::json parse_json(std::string_view text, const std::string& source);

}  // namespace houghstream
