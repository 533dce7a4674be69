#include "pipeline/bus/channel_pattern.hpp"

#include <re2/re2.h>

#include <cstdint>
#include <memory>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/printable.hpp"

namespace houghstream {
namespace {

re2::RE2::Options expression_options() {
  constexpr std::int64_t kMaxMemory = std::int64_t{1} << 20;  // bytes of an expression and of its cache for matching
  re2::RE2::Options options;
  options.set_encoding(re2::RE2::Options::EncodingLatin1);  // a name is bytes, which need not be UTF-8
  options.set_never_capture(true);
  options.set_max_mem(kMaxMemory);
  options.set_log_errors(false);
  return options;
}

std::function<bool(const std::string&)> matcher_of(const std::string& text, bool is_name) {
  if (is_name) return [text](const std::string& channel) { return channel == text; };
  // The expression is not matched by std::regex, nor by any other backtracking engine, which few bytes of an expression
  // could keep busy for ever.
  const auto expression = std::make_shared<const re2::RE2>(text, expression_options());
  require(expression->ok(), "channels '{}': {}, expected a regular expression", printable(text),
          printable(expression->error()));
  return [expression](const std::string& channel) { return re2::RE2::FullMatch(channel, *expression); };
}

}  // namespace

ChannelPattern::ChannelPattern(const std::string& text)
    : text_(text),
      is_name_(text.find_first_of("\\^$.|?*+()[]{}") == std::string::npos),
      matches_(matcher_of(text, is_name_)) {}

}  // namespace houghstream
