#pragma once

#include <string>

namespace houghstream::log_tools {

/// Names may hold commas and quotes.
inline std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + '"';
}

}  // namespace houghstream::log_tools
