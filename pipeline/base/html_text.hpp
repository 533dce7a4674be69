#pragma once

#include <string>
#include <string_view>

namespace houghstream {

/// Returns untrusted text (the name of an object, a file's name) escaped for an HTML page or a quoted attribute of one:
/// it is shown literally and is no markup. It works as printable_lines() otherwise.
std::string escape_html(std::string_view text);

}  // namespace houghstream
