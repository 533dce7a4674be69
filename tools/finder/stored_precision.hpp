#pragma once

#include <map>
#include <optional>
#include <string>

#include "drivers/store/precision_thresholds.hpp"
#include "pose/pose_settings.hpp"
#include "tools/finder/search_options.hpp"

namespace houghstream {

/// Returns the options, with the least score of each object for the precision that was asked for, if one was. Throws
/// InputError as store::thresholds_for_precision().
inline SearchOptions with_precision(SearchOptions options, const store::ObjectStore& store,
                                    std::optional<double> precision) {
  if (precision)
    options.class_thresholds = store::thresholds_for_precision(store, store::PracticeMeasure::kScore, *precision);
  return options;
}

/// Publishes poses, those of candidates too, from the quality on that each object needs for this precision. Throws
/// InputError as store::thresholds_for_precision().
inline void set_precision(double precision, const store::ObjectStore& store, PoseSettings& settings) {
  const std::map<std::string, float> thresholds =
      store::thresholds_for_precision(store, store::PracticeMeasure::kQuality, precision);
  for (const auto& [name, threshold] : thresholds) {
    QualitySettings& judged_by = settings.class_quality.emplace(name, settings.quality).first->second;
    judged_by.min_quality = judged_by.min_candidate_quality = threshold;
  }
}

}  // namespace houghstream
