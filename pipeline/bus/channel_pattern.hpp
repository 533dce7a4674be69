#pragma once

#include <functional>
#include <string>

namespace houghstream {

/// Channels as the option -c means them everywhere, on the bus and in a log: a regular expression (ECMAScript's, which
/// LCM's own agree with as far as channels go) that a channel's whole name has to match, for instance OPENNI_FRAME,
/// "LEFT|RIGHT" or "CAMERA_.*". An expression matches no name that is longer than channel::kMostBytes. May be used from
/// any thread.
class ChannelPattern {
 public:
  /// Throws InputError where `text` is no regular expression.
  explicit ChannelPattern(const std::string& text);

  bool matches(const std::string& channel) const { return matches_(channel); }

  /// Whether it stands for one channel, which it names; otherwise several may match.
  bool is_name() const { return is_name_; }

  const std::string& text() const { return text_; }

 private:
  std::string text_;
  bool is_name_;
  std::function<bool(const std::string&)> matches_;
};

}  // namespace houghstream
