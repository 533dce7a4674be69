#pragma once

#include <unistd.h>

#include <cstdlib>
#include <string>

namespace houghstream {

/// Colours of words on a terminal: SGR 31 to 33 (ECMA-48, 8.3.117).
enum class TerminalColour { kRed = 31, kGreen = 32, kYellow = 33 };

/// Returns whether words on this file descriptor are shown in colours: it is a terminal that knows them, and NO_COLOR
/// (https://no-color.org) is not set.
inline bool shows_colours(int file_descriptor) {
  const char* unwanted = std::getenv("NO_COLOR");
  const char* terminal = std::getenv("TERM");
  const bool is_unwanted = unwanted != nullptr && *unwanted != '\0';
  const bool is_known = terminal != nullptr && *terminal != '\0' && std::string(terminal) != "dumb";
  return isatty(file_descriptor) == 1 && !is_unwanted && is_known;
}

/// Returns the words in the colour where `is_shown`, else as they are.
inline std::string in_colour(const std::string& words, TerminalColour colour, bool is_shown) {
  return is_shown ? "\x1b[" + std::to_string(static_cast<int>(colour)) + "m" + words + "\x1b[0m" : words;
}

}  // namespace houghstream
