#pragma once

#include <string>
#include <string_view>

namespace houghstream {

/// Text of somebody else's making (a channel, a class, an error off the wire, a file's name) as it may go to a
/// terminal: control characters (C0, DEL and, of UTF-8, C1), those that turn the direction of text, and bytes that are
/// not UTF-8 become \xNN, a line's end too. What may be shown stays as it is.
std::string printable(std::string_view text);

/// Makes a text of several lines printable.
std::string printable_lines(std::string_view text);

/// Returns whether the whole text is UTF-8 (RFC 3629).
bool is_utf8(std::string_view text);

}  // namespace houghstream
