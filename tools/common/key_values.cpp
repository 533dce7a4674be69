#include "tools/common/key_values.hpp"

#include <map>

#include "pipeline/base/checks.hpp"
#include "tools/common/trimmed.hpp"

namespace houghstream {
namespace {

bool is_quoted(const std::string& words) {
  return !words.empty() && (words.front() == '"' || words.front() == '\'');
}

/// Returns the text in the quotes that `words` begin with. Behind them only a comment may follow.
std::string quoted_text(const std::string& words, int line) {
  const std::size_t end = words.find(words.front(), 1);
  require(end != std::string::npos, "line {}: {} has no end, expected a second {}", line, words, words.front());
  const std::string rest = trimmed(words.substr(end + 1));
  require(rest.empty() || rest.front() == '#', "line {}: '{}' behind a text in quotes, expected nothing more", line,
          rest);
  return words.substr(1, end - 1);
}

KeyValue parse_line(const std::string& words, int line) {
  require(words.front() != '[', "line {}: {}, expected key = value: there are no sections", line, words);
  const std::size_t equals = words.find('=');
  require(equals != std::string::npos && equals > 0, "line {}: {}, expected key = value", line, words);
  const std::string key = trimmed(words.substr(0, equals));
  const std::string value = trimmed(words.substr(equals + 1));
  KeyValue parsed;
  parsed.key = is_quoted(key) ? quoted_text(key, line) : key;
  parsed.value = is_quoted(value) ? quoted_text(value, line) : trimmed(value.substr(0, value.find('#')));
  require(is_quoted(value) || !parsed.value.empty(), "line {}: {} has no value, expected key = value", line, key);
  return parsed;
}

}  // namespace

std::vector<KeyValue> read_key_values(std::istream& in) {
  std::vector<KeyValue> all;
  std::map<std::string, int> lines;  // line by key
  int line = 0;
  for (std::string text; std::getline(in, text);) {
    ++line;
    const std::string words = trimmed(text);
    if (words.empty() || words.front() == '#') continue;
    all.push_back(parse_line(words, line));
    const auto [first, is_new] = lines.emplace(all.back().key, line);
    require(is_new, "line {}: '{}' is in line {} already", line, all.back().key, first->second);
  }
  return all;
}

}  // namespace houghstream
