#include "detector/detection_settings.hpp"

#include <fmt/ranges.h>

#include "detector/features/feature_families.hpp"
#include "detector/forest/forest.hpp"
#include "pipeline/base/checks.hpp"

namespace houghstream {

std::vector<std::string> profile_names() {
  return {kPaperProfile, kRealtimeProfile};
}

DetectionSettings detection_settings(const std::string& profile) {
  DetectionSettings settings;
  if (profile == kRealtimeProfile) return settings;
  require(profile == kPaperProfile, "profile '{}', expected one of {}, or a program with {}", profile,
          fmt::join(profile_names(), ", "), kStudyPrograms);
  settings.spacing.stride = 1;
  settings.spacing.metres = 0.0F;
  settings.leaves.first_trees = 0;
  return settings;
}

DetectionSettings detection_settings(const Forest& forest) {
  return detection_settings(forest.profile);
}

}  // namespace houghstream
