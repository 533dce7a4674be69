#pragma once

#include <functional>
#include <optional>
#include <string>

#include "pipeline/bus/lcm_bus.hpp"
#include "pipeline/types/detection.hpp"
#include "pipeline/types/frame.hpp"

namespace houghstream {

struct DetectProcessOptions {
  std::string process = "hs-detect";  ///< its name in status_t
  std::string frame_channel = "OPENNI_FRAME";
  std::optional<Camera> camera;  ///< for frames that do not bring their own
};

/// Receives frames and publishes `detect`'s result for each one that is worked on: on a network always the newest,
/// from a log every one. A frame that cannot be understood is counted, reported and dropped. Returns as
/// run_process_loop does.
void run_detect_process(LcmBus& bus, const DetectProcessOptions& options,
                        const std::function<Detections(const RgbdFrame&)>& detect);

}  // namespace houghstream
