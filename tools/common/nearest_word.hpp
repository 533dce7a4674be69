#pragma once

#include <string>
#include <vector>

namespace houghstream {

/// The one of `words` that looks most like `word`; empty where there are none.
std::string nearest_word(const std::string& word, const std::vector<std::string>& words);

/// The one of `words` that `word` is likely a slip of: less than half of its letters are others. Empty without one.
std::string suggest_word(const std::string& word, const std::vector<std::string>& words);

}  // namespace houghstream
