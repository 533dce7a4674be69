#pragma once

#include <string>
#include <string_view>

namespace houghstream {

/// Returns text of somebody else's making (the name of an object, a file's name) as it may stand in an HTML page or in
/// a quoted attribute of one: it is shown as it is and is no markup. As printable_lines() otherwise.
std::string escape_html(std::string_view text);

}  // namespace houghstream
