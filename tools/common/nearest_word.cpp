#include "tools/common/nearest_word.hpp"

#include <algorithm>
#include <cstddef>

namespace houghstream {
namespace {

/// Letters to change, add or take away (Levenshtein 1966).
std::size_t edits_between(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t changed = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({changed, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

}  // namespace

std::string nearest_word(const std::string& word, const std::vector<std::string>& words) {
  const auto nearest = std::min_element(words.begin(), words.end(), [&](const std::string& a, const std::string& b) {
    return edits_between(a, word) < edits_between(b, word);
  });
  return nearest == words.end() ? "" : *nearest;
}

std::string suggest_word(const std::string& word, const std::vector<std::string>& words) {
  const std::string nearest = nearest_word(word, words);
  return 2 * edits_between(nearest, word) < word.size() ? nearest : "";
}

}  // namespace houghstream
