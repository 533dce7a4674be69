#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "detector/detector.hpp"
#include "pipeline/base/checks.hpp"

namespace houghstream {

/// From which score on weaker detections are handed to hs-pose as candidates. In 88 images of furnished rooms with 21
/// objects, poses from 0.1 on publish 251 of them, 10 of them wrong; from 0.2 on 246, 10 of them wrong as well.
constexpr float kCandidatesFrom = 0.1F;

/// Options of a command line that override a forest's detection settings.
struct SearchOptions {
  std::optional<int> stride;
  std::optional<float> threshold;
  std::map<std::string, float> class_thresholds{};  ///< of single classes, by name
  std::optional<float> min_mass_fraction;
  float candidates_from = 1.0F;  ///< none
  bool learn_camera_colours = true;
  int threads = 2;

  DetectionSettings settings_for(const Forest& forest) const { return change(detection_settings(forest)); }

  DetectionSettings change(DetectionSettings settings) const {
    if (stride) settings.spacing.metres = 0.0F;  // what was asked for is a patch at every so many-th pixel
    settings.spacing.stride = stride.value_or(settings.spacing.stride);
    settings.evidence.threshold = threshold.value_or(settings.evidence.threshold);
    settings.evidence.class_thresholds = class_thresholds;
    settings.evidence.candidates_from = candidates_from;
    settings.evidence.learn_camera_colours = learn_camera_colours;
    settings.voting.min_mass_fraction = min_mass_fraction.value_or(settings.voting.min_mass_fraction);
    settings.threads = threads;
    return settings;
  }
};

/// Searches the groups of a store, or a forest by itself, as their profile says and the options change it.
inline Detector detector_of(std::vector<Forest> groups, const SearchOptions& options) {
  require(!groups.empty(), "no forest, expected one for each group of objects");
  const DetectionSettings settings = options.settings_for(groups.front());
  return Detector(std::move(groups), settings);
}

inline Detector detector_of(Forest forest, const SearchOptions& options) {
  const DetectionSettings settings = options.settings_for(forest);
  return Detector(std::move(forest), settings);
}

}  // namespace houghstream
