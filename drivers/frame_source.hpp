#pragma once

#include <optional>

#include "pipeline/types/frame.hpp"

namespace houghstream {

/// Delivers frames from a source: a dataset folder, a recording, a camera. It is one of the few virtual interfaces,
/// since several sensors stand behind it.
class FrameSource {
 public:
  virtual ~FrameSource() = default;

  /// Returns the next frame, or nothing at the end. Throws InputError where a frame cannot be read.
  virtual std::optional<RgbdFrame> next() = 0;

  /// Returns the frames per second at which the source was recorded, or runs.
  virtual double rate_hz() const = 0;

  /// Returns whether frames arrive in real time, as a camera's do; those of a recording come as soon as they are
  /// requested.
  virtual bool is_live() const { return false; }
};

}  // namespace houghstream
