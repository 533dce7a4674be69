#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <set>
#include <string>

namespace houghstream {

/// Detects that no frame arrives on the wanted channels, and on which channels frames arrive instead: otherwise the
/// only symptom of a wrong channel is silence. Listening to all channels costs the receiver all traffic, so it is done
/// for short times only, while nothing arrives. Times are parameters. Not thread-safe.
class FrameSilence {
 public:
  using Clock = std::chrono::steady_clock;

  static constexpr std::chrono::milliseconds kListenAfter{2000};  ///< of silence before it listens to all channels
  static constexpr std::chrono::milliseconds kListen{1500};       ///< for which it listens to all channels
  static constexpr std::chrono::milliseconds kPause{8000};        ///< before it listens to all channels again
  static constexpr std::chrono::milliseconds kNowhere{10'000};    ///< of silence on all channels before that is logged

  FrameSilence(std::string wanted, Clock::time_point now) : wanted_(std::move(wanted)), last_(now), next_(now) {}

  /// A frame has come on a channel that is wanted.
  void note_wanted(Clock::time_point now) { last_ = now; }

  /// While it is listened to all channels: a frame has come on this one.
  void note_elsewhere(const std::string& channel);

  /// Returns whether all channels are to be received now.
  bool wants_to_listen(Clock::time_point now);

  /// Returns the line to log, once for each different finding.
  std::optional<std::string> words(Clock::time_point now);

 private:
  std::string wanted_;
  Clock::time_point last_;                  // time of the last wanted frame, or the beginning
  Clock::time_point next_;                  // time before which it does not listen
  std::optional<Clock::time_point> since_;  // time since which it listens
  std::set<std::string> elsewhere_;
  bool has_listened_ = false;  // a listening period has ended since words() was called last
  std::string told_;
};

/// Returns "no frame on WANTED; frames come on A, B" for people. `elsewhere` are names off the wire.
std::string frames_elsewhere(const std::string& wanted, const std::set<std::string>& elsewhere);

}  // namespace houghstream
