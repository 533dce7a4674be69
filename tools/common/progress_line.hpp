#pragma once

#include <cstddef>
#include <functional>
#include <mutex>
#include <string>

namespace houghstream {

/// Returns "scene: 45 %, about 12 s left" after so many seconds; of a work whose `whole` is 0, since it is unknown,
/// "scene: 340 so far".
std::string progress_words(const std::string& title, double done, double whole, double seconds);

/// Output for a line of progress.
struct ProgressOutput {
  std::function<double()> seconds;  ///< since any moment
  std::function<void(const std::string&)> write;
  bool is_terminal = false;  ///< a line can be written over
};

/// Returns stderr, with this machine's steady clock.
ProgressOutput progress_on_stderr();

/// Says how far a work is and how long it still takes: nothing in its first two seconds; then, on a terminal, one line
/// that changes and goes when the work is done, and elsewhere a line every ten seconds.
class ProgressLine {
 public:
  /// Begins a line. `whole` is all there is to do, in any unit; 0 where it is unknown.
  ProgressLine(const std::string& title, double whole, ProgressOutput output = progress_on_stderr());
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// Reports that so much is done by now. Any thread may call.
  void at(double done);
  /// Reports that so much more is done.
  void add(double more);

 private:
  void say(double done);

  std::string title_;
  double whole_;
  ProgressOutput output_;
  double begin_;
  std::mutex mutex_;
  double done_ = 0.0;
  double due_;              // seconds after the beginning
  std::size_t length_ = 0;  // length of the line that stands on the terminal
};

}  // namespace houghstream
