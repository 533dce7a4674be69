#pragma once

#include "detector/baseline/reference_stages.hpp"
#include "detector/stages.hpp"

namespace houghstream::baseline {

/// Searches as Detector does, and also what that refuses, for comparisons: forests of a scale space, forests with
/// surface features, and every forest in the reference way. Several threads may use one detector, each with a workspace
/// of its own.
class StudyDetector {
 public:
  StudyDetector(Forest forest, const DetectionSettings& settings, Way way = Way::kFast);
  StudyDetector(const StudyDetector&) = delete;
  StudyDetector& operator=(const StudyDetector&) = delete;

  /// Detects as Detector::detect does; a forest of a scale space has no stage "detect.evidence".
  Detections detect(const RgbdFrame& frame, DetectorWorkspace& workspace) const;
  Detections detect(const RgbdFrame& frame) const;

 private:
  Forest forest_;
  ForestIndex index_;
  DetectionSettings settings_;
  Way way_;
};

}  // namespace houghstream::baseline
