#pragma once

#include <istream>
#include <string>
#include <vector>

namespace houghstream {

/// A line `key = value` of a configuration file, without the quotes.
struct KeyValue {
  std::string key;
  std::string value;
};

/// Reads a file of such lines, as TOML has them: a text in quotes or a bare word, and '#' begins a comment. Throws
/// InputError, which begins with the line's number, for any other line, for a section, and for a key that comes twice.
std::vector<KeyValue> read_key_values(std::istream& in);

}  // namespace houghstream
