#pragma once

#include <functional>
#include <string>

namespace houghstream {

/// Channels as the option -c means them everywhere, on the bus and in a log: a regular expression in RE2's syntax (no
/// look-ahead, no back-references) that a channel's whole name has to match, for instance OPENNI_FRAME, "LEFT|RIGHT" or
/// "CAMERA_.*". Whatever the expression, the time to match grows with the length of the name only, and memory is
/// bounded. May be used from any thread.
///
/// LcmBus hands an expression to LCM too: on a network a message comes where both match. LCM's are Perl's, which take
/// what RE2 takes and mean the same by it for names of ASCII. LCM asks its own once for each name that is new, and that
/// one may try many ways through a name, until a limit of its library ends it.
class ChannelPattern {
 public:
  /// Throws InputError where `text` is no regular expression.
  explicit ChannelPattern(const std::string& text);

  bool matches(const std::string& channel) const { return matches_(channel); }

  /// Returns whether the pattern names a single channel; otherwise several may match.
  bool is_name() const { return is_name_; }

  const std::string& text() const { return text_; }

 private:
  std::string text_;
  bool is_name_;
  std::function<bool(const std::string&)> matches_;
};

}  // namespace houghstream
