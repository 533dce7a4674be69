#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "pipeline/types/detection.hpp"
#include "pipeline/types/frame.hpp"

namespace houghstream {

/// Something whose time on a frame is measured beside that of others.
struct BenchmarkedDetector {
  std::string name;
  std::size_t frames = SIZE_MAX;     ///< looks at no more than so many of the frames; for slow ones
  std::int64_t instruction_set = 0;  ///< of Highway, that alone; 0 = the best that the processor has
  double image_scale = 1.0;          ///< size of the frames that it is given over that of the scene's
  std::function<Detections(const RgbdFrame&)> detect;
};

/// A detector as a command line names it: "NAME=FOREST", then any of ",threads=N" (default 2), ",reference",
/// ",set=SSE4|AVX2|AVX3" and so on (the names of Highway), ",frames=N", ",trees=N" (the first so many), ",scale=X",
/// ",threshold=X" and ",min-mass=X" (as of hs-evaluate, so that time and accuracy are of the same settings).
/// Loads the forest. Throws InputError naming what was not understood.
BenchmarkedDetector parse_contender(const std::string& text);

/// The frame with its image `scale` times as large: colour interpolated, depth of the nearest pixel.
RgbdFrame resized_frame(const RgbdFrame& frame, double scale);

}  // namespace houghstream
