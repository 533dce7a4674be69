#include "tools/stream/shell_words.hpp"

#include <utility>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/printable.hpp"

namespace houghstream::stream {
namespace {

/// Within '...' a backslash is one; within "..." it is one before all but what it is needed for there.
bool escapes(const std::string& text, std::size_t at, char quote) {
  if (text[at] != '\\' || quote == '\'') return false;
  return quote == '\0' || text.compare(at + 1, 1, "\"") == 0 || text.compare(at + 1, 1, "\\") == 0;
}

}  // namespace

std::vector<std::string> shell_words(const std::string& text, const std::string& source) {
  std::vector<std::string> words;
  std::string word;
  bool has_begun = false;  // the word, which may be ""
  char quote = '\0';       // that has begun
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool is_blank = c == ' ' || c == '\t' || c == '\n';
    if (quote == '\0' && is_blank) {
      if (has_begun) words.push_back(std::exchange(word, ""));
      has_begun = false;
      continue;
    }
    has_begun = true;
    if (quote != '\0' ? c == quote : c == '\'' || c == '"') {
      quote = quote == '\0' ? c : '\0';
    } else if (escapes(text, i, quote)) {
      ++i;
      require(i < text.size(), "{} '{}': nothing follows its last backslash", source, printable(text));
      word += text[i];
    } else {
      word += c;
    }
  }
  require(quote == '\0', "{} '{}': a quote has no end, expected another {}", source, printable(text), quote);
  if (has_begun) words.push_back(word);
  return words;
}

}  // namespace houghstream::stream
