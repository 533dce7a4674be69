#include "pipeline/base/text_nesting.hpp"

#include <algorithm>

#include "pipeline/base/checks.hpp"

namespace houghstream {

void check_json_nesting(std::string_view text, const std::string& source) {
  constexpr int kDeepest = 64;
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (in_string && text[i] == '\\') {
      ++i;
    } else if (text[i] == '"') {
      in_string = !in_string;
    } else if (!in_string) {
      depth += text[i] == '[' || text[i] == '{' ? 1 : text[i] == ']' || text[i] == '}' ? -1 : 0;
    }
    require(depth <= kDeepest, "{}: lists within lists more than {} times", source, kDeepest);
  }
}

void check_yaml_nesting(std::string_view text, const std::string& source) {
  constexpr std::size_t kMostBytes = std::size_t{1} << 20U;
  constexpr std::size_t kLongestLine = 512;
  constexpr std::ptrdiff_t kMostBrackets = 600;
  require(text.size() <= kMostBytes, "{}: {} bytes of YAML, expected at most {}", source, text.size(), kMostBytes);
  const std::ptrdiff_t brackets = std::count_if(text.begin(), text.end(), [](char c) { return c == '[' || c == '{'; });
  require(brackets <= kMostBrackets, "{}: {} brackets, expected at most {}", source, brackets, kMostBrackets);
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find_first_of("\r\n", begin), text.size());
    require(end - begin <= kLongestLine, "{}: a line of {} bytes, expected at most {}", source, end - begin,
            kLongestLine);
    begin = end + 1;
  }
}

}  // namespace houghstream
