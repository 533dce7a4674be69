#include "pipeline/text/yaml_text.hpp"

#include <algorithm>
#include <cstddef>
#include <sstream>

#include "pipeline/base/checks.hpp"

namespace houghstream {
namespace {

void check_nesting(const std::string& text, const std::string& source) {
  constexpr std::size_t kMostBytes = std::size_t{1} << 20U;
  constexpr std::size_t kLongestLine = 512;
  constexpr std::ptrdiff_t kMostBrackets = 600;
  // At a byte 0 within a list OpenCV's reader goes round for ever.
  require(text.find('\0') == std::string::npos, "{}: holds a byte 0, expected text", source);
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

}  // namespace

std::string yaml_for_opencv(const std::string& text, const std::string& source) {
  check_nesting(text, source);
  std::string out = "%YAML:1.0\n---\n";
  bool in_list = false;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line.rfind("---", 0) == 0 || line.rfind("%YAML", 0) == 0) continue;
    if (line[0] != ' ') in_list = line[0] == '-';
    out += (in_list ? "  " : "") + line + "\n";
  }
  return out;
}

}  // namespace houghstream
