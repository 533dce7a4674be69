#pragma once

#include <memory>

#include "detector/detector_settings.hpp"
#include "detector/forest/forest.hpp"
#include "pipeline/types/detection.hpp"
#include "pipeline/types/frame.hpp"

namespace houghstream {

/// Finds the taught objects in an RGB-D frame: depth-normalised Hough Forest (Haensch, Kaiser, Hellwich,
/// VISAPP 2017, after Gall et al., PAMI 2011).
class Detector {
 public:
  Detector(Forest forest, DetectionSettings settings);
  ~Detector();
  Detector(Detector&&) noexcept;

  /// Detections above settings.threshold, strongest first, with stage times "detect.*" appended to the frame's.
  /// Same forest, frame and settings: same result, bit for bit, for any number of threads.
  Detections detect(const RgbdFrame& frame) const;

  const Forest& forest() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace houghstream
