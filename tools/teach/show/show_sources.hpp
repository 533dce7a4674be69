#pragma once

#include <utility>

#include "tools/teach/show/show_options.hpp"
#include "tools/teach/show/teaching_publisher.hpp"

namespace houghstream::teach {

/// Opens the frames of a camera (openni2...), which end after `options.max_duration_s` or with a stop signal, or of a
/// recording: log:FILE or FILE of any kind that hs-log import reads, bop:DIR, uw:DIR, tum:DIR, bag:FILE. Throws
/// InputError where it cannot be opened.
ShownFrames open_shown(const std::string& source, const ShowOptions& options);

/// Returns whether a source's frames arrive in real time: openni2 or openni2:CAMERA, or a stream's, stream:CHANNEL.
bool is_live(const std::string& source);

/// A take of a camera whose carrier cannot reach the keyboard: it ends when enough of the object was observed, or when
/// the frames end. From then on a stop signal ends the program.
class CameraTake : public ShowObserver {
 public:
  /// Makes a take. `observer` (may be null) receives all its events.
  CameraTake(ShownFrames frames, ShowObserver* observer) : frames_(std::move(frames)), observer_(observer) {}

  std::optional<RgbdFrame> next();
  void progress(const ShowProgress& now) override;

 private:
  ShownFrames frames_;
  ShowObserver* observer_;
  CoverageCriterion is_covered_;
  bool is_over_ = false;
};

}  // namespace houghstream::teach
