#pragma once

#include <optional>

#include "detector/detection_settings.hpp"
#include "tools/common/command_line.hpp"

namespace houghstream {

/// From which score on weaker detections are handed to hs-pose as candidates. In the development rooms poses that are
/// right in 98 % of the cases confirm half of the objects among them; from 0.1 on they bring as many that are wrong.
constexpr float kCandidatesFrom = 0.2F;

/// What a command line changes of a forest's own detection settings.
struct SearchOptions {
  std::optional<int> stride;
  std::optional<float> threshold;
  std::optional<float> min_mass_share;
  float candidates_from = 1.0F;  ///< none
  int threads = 2;

  DetectionSettings settings_for(const Forest& forest) const { return change(detection_settings(forest)); }

  DetectionSettings change(DetectionSettings settings) const {
    if (stride) settings.spacing.metres = 0.0F;  // what was asked for is a patch at every so many-th pixel
    settings.spacing.stride = stride.value_or(settings.spacing.stride);
    settings.evidence.threshold = threshold.value_or(settings.evidence.threshold);
    settings.evidence.candidates_from = candidates_from;
    settings.voting.min_mass_share = min_mass_share.value_or(settings.voting.min_mass_share);
    settings.threads = threads;
    return settings;
  }
};

inline void add_search_options(CommandLine& app, SearchOptions& options) {
  app.add_option("--threads", options.threads, "threads").range(1, 64).capture_default_str();
  app.add_option("--threshold", options.threshold, "smallest score reported; default: the profile's").range(0.0, 1.0);
  app.add_option("--stride", options.stride,
                 "patch offset, working pixels, whatever the distance; default: the profile's")
      .range(1, 64);
}

}  // namespace houghstream
