#pragma once

#include <functional>
#include <memory>
#include <utility>

#include "detector/baseline/study_detector.hpp"
#include "tools/common/command_line.hpp"

namespace houghstream {

inline void add_reference_option(CommandLine& app, bool& reference) {
  app.add_flag("--reference", reference, "by the slow reference engine; the same detections");
}

inline baseline::Way way_of(bool reference) {
  return reference ? baseline::Way::kReference : baseline::Way::kFast;
}

/// Finds the objects in a frame, with memory of its own that it uses again. For one frame at a time.
inline std::function<Detections(const RgbdFrame&)> study_search(Forest forest, const DetectionSettings& settings,
                                                                bool reference) {
  const auto detector = std::make_shared<const baseline::StudyDetector>(std::move(forest), settings, way_of(reference));
  const auto workspace = std::make_shared<DetectorWorkspace>();
  return [detector, workspace](const RgbdFrame& frame) { return detector->detect(frame, *workspace); };
}

}  // namespace houghstream
