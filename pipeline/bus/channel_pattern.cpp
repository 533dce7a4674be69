#include "pipeline/bus/channel_pattern.hpp"

#include <regex>

#include "pipeline/base/checks.hpp"
#include "pipeline/bus/channels.hpp"
#include "pipeline/text/printable.hpp"

namespace houghstream {
namespace {

std::function<bool(const std::string&)> matcher_of(const std::string& text, bool is_name) {
  if (is_name) return [text](const std::string& channel) { return channel == text; };
  try {
    // std::regex goes a step deeper into the stack for each character, and a message may name any channel.
    return [expression = std::regex(text)](const std::string& channel) {
      return channel.size() <= channel::kMostBytes && std::regex_match(channel, expression);
    };
  } catch (const std::regex_error& error) {
    fail("channels '{}': {}, expected a regular expression", printable(text), error.what());
  }
}

}  // namespace

ChannelPattern::ChannelPattern(const std::string& text)
    : text_(text),
      is_name_(text.find_first_of("\\^$.|?*+()[]{}") == std::string::npos),
      matches_(matcher_of(text, is_name_)) {}

}  // namespace houghstream
