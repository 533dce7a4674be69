#pragma once

#include <cstdint>
#include <string>

#include "pipeline/types/frame_id.hpp"
#include "pose/reconstruction/tracking/take_placer.hpp"
#include "tools/teach/show/show_progress.hpp"

namespace houghstream::teach {

/// Tells the observer and, where something new happens, the terminal how far a showing is. Not thread-safe.
class ProgressReporter {
 public:
  /// Of the object's `name`. `observer` may be null.
  ProgressReporter(const std::string& name, ShowObserver* observer);

  /// After a frame of the take.
  void frame(const FrameId& id, const reconstruction::TakePlacerStatus& state);

  /// A step after the takes; `progress` of all work, 0 to 1.
  void step(ShowState state, double progress, const std::string& message);

  /// The terminal gets the exception's line itself.
  void fail(const std::string& message);

 private:
  void tell();

  ShowObserver* observer_;
  ShowProgress now_;
  std::string printed_;
  ShowState printed_state_ = ShowState::kChoosing;
  std::int64_t printed_us_ = 0;
};

}  // namespace houghstream::teach
