#pragma once

#include <utility>

#include "tools/teach/show/show_options.hpp"
#include "tools/teach/show/teaching_publisher.hpp"

namespace houghstream::teach {

/// Whether a source's frames come at their own time: openni2 or openni2:CAMERA, or a stream's, stream:CHANNEL.
bool is_live(const std::string& source);

/// A take of a camera, which somebody carries who cannot reach the keyboard: it ends when enough was seen, or when the
/// frames do. From then on a stop signal ends the program.
class CameraTake : public ShowObserver {
 public:
  /// `observer` (may be null) hears all that this does.
  CameraTake(ShownFrames frames, ShowObserver* observer) : frames_(std::move(frames)), observer_(observer) {}

  std::optional<RgbdFrame> next();
  void progress(const ShowProgress& now) override;

 private:
  ShownFrames frames_;
  ShowObserver* observer_;
  CoverageCriterion enough_;
  bool is_over_ = false;
};

}  // namespace houghstream::teach
