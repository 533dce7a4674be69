#pragma once

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/base/printable.hpp"

// Lines, words and numbers of meshes that are text; for ply_structure.cpp and obj_structure.cpp only.

namespace houghstream::mesh_text {

using Words = std::vector<std::string_view>;

inline std::string shown(std::string_view text) {
  constexpr std::size_t kMax = 40;
  return printable(text.substr(0, kMax));
}

/// Lines without their ends; takes one off the front.
class Lines {
 public:
  explicit Lines(std::string_view text) : text_(text) {}

  std::optional<std::string_view> next() {
    if (text_.empty()) return std::nullopt;
    const std::size_t end = text_.find('\n');
    std::string_view line = text_.substr(0, end);
    is_ended_ = end != std::string_view::npos;
    text_.remove_prefix(is_ended_ ? end + 1 : text_.size());
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    ++number_;
    return line;
  }

  std::int64_t number() const { return number_; }  ///< of the last line, from 1
  bool is_ended() const { return is_ended_; }      ///< the last line had an end
  std::string_view rest() const { return text_; }

 private:
  std::string_view text_;
  std::int64_t number_ = 0;
  bool is_ended_ = true;
};

inline Words split(std::string_view line) {
  Words words;
  while (true) {
    const std::size_t begin = line.find_first_not_of(" \t");
    if (begin == std::string_view::npos) return words;
    const std::size_t end = std::min(line.find_first_of(" \t", begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    line.remove_prefix(end);
  }
}

template <typename Number>
std::optional<Number> number_of(std::string_view word) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  Number value{};
  const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  // A number too small for a double is a zero that was written down exactly.
  const bool is_number = error == std::errc() || error == std::errc::result_out_of_range;
  return is_number && stop == word.data() + word.size() && !word.empty() ? std::optional<Number>(value) : std::nullopt;
}

}  // namespace houghstream::mesh_text
