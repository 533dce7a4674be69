#include "pipeline/base/json_nesting.hpp"

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

}  // namespace houghstream
