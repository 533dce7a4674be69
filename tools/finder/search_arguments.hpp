#pragma once

#include <optional>

#include "drivers/store/practice_record.hpp"
#include "pipeline/base/check_settings.hpp"
#include "pose/verification/quality.hpp"
#include "tools/common/command_line.hpp"
#include "tools/finder/search_options.hpp"

namespace houghstream {

inline CommandOption add_threads_option(CommandLine& app, int& threads) {
  constexpr int kMaxThreads = 64;  // of a program that looks at frames; those that teach take more
  return app.add_option("--threads", threads, "threads").range(1, kMaxThreads).capture_default_str();
}

inline void add_search_options(CommandLine& app, SearchOptions& options) {
  add_threads_option(app, options.threads);
  app.add_option("--threshold", options.threshold, "smallest score reported; default: the profile's")
      .range(range_of(&EvidenceSettings::threshold));
  app.add_option("--stride", options.stride,
                 "patch offset, working pixels, whatever the distance; default: the profile's")
      .range(range_of(&PatchSpacing::stride));
}

inline CommandOption add_min_mass_option(CommandLine& app, SearchOptions& options) {
  return app
      .add_option("--min-mass", options.min_mass_fraction,
                  "vote mass, over a whole object's, from which a maximum counts; default: the profile's")
      .range(range_of(&VotingSettings::min_mass_fraction));
}

inline CommandOption add_min_quality_option(CommandLine& app, std::optional<float>& min_quality) {
  return app.add_option("--min-quality", min_quality).range(range_of(&QualitySettings::min_quality));
}

/// Adds the option by which an object store's own practice chooses thresholds.
inline CommandOption add_precision_option(CommandLine& app, std::optional<double>& precision,
                                          const std::string& words) {
  return app.add_option("--precision", precision, words).range(0.0, store::kMaxPrecision);
}

}  // namespace houghstream
