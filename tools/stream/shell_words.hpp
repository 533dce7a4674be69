#pragma once

#include <string>
#include <vector>

namespace houghstream::stream {

/// The words of a text as a shell tells them apart: by blanks, except for those within '...', within "..." and behind a
/// backslash. Throws InputError that names `source` where a quote has no end or nothing follows a backslash.
std::vector<std::string> shell_words(const std::string& text, const std::string& source);

}  // namespace houghstream::stream
