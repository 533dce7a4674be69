#pragma once

#include "pipeline/types/frame_id.hpp"

namespace houghstream {

/// By how much later than its colours a camera takes the depth of a frame.
struct CameraTiming {
  FrameId frame;             ///< the newest that was learnt from
  double depth_lag_s = 0.0;  ///< seconds; negative where depth is the older one
  double sigma_s = 0.0;      ///< standard deviation of that, seconds
};

}  // namespace houghstream
