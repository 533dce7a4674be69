#pragma once

#include <string>
#include <string_view>

namespace houghstream {

/// Returns untrusted text (a channel, a class, an error off the wire, a file's name) for a terminal: control characters
/// (C0, DEL and, of UTF-8, C1), those that reverse the direction of text, and bytes that are not UTF-8 become \xNN,
/// line ends too. All other characters stay.
std::string printable(std::string_view text);

/// Makes a text of several lines printable.
std::string printable_lines(std::string_view text);

/// Returns whether the whole text is UTF-8 (RFC 3629).
bool is_utf8(std::string_view text);

}  // namespace houghstream
