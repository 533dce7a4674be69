#pragma once

#include <string>
#include <vector>

#include "detector/evidence/evidence_settings.hpp"
#include "detector/features/patch_settings.hpp"
#include "detector/forest/leaf_settings.hpp"
#include "detector/voting/voting_settings.hpp"
#include "pipeline/base/check_settings.hpp"
#include "pipeline/base/settings_fields.hpp"

namespace houghstream {

struct Forest;

/// Settings of a search: those of each stage, which are declared beside the stage. The defaults are those of the
/// profile "realtime".
struct DetectionSettings {
  int threads = 2;  ///< any number gives the same detections
  PatchSpacing spacing;
  LeafSettings leaves;
  VotingSettings voting;
  EvidenceSettings evidence;
  SuppressionSettings suppression;
};

template <typename Visit>
void fields(const DetectionSettings& /*settings*/, const Visit& visit) {
  using S = DetectionSettings;
  visit(number("threads", &S::threads, 1, 256));
  visit(group("spacing", &S::spacing));
  visit(group("leaves", &S::leaves));
  visit(group("voting", &S::voting));
  visit(group("evidence", &S::evidence));
  visit(group("suppression", &S::suppression));
}

/// Checks the settings as described in pipeline/base/check_settings.hpp, and the thresholds of single classes too.
inline void check_settings(const DetectionSettings& settings, const std::string& source) {
  check_fields(settings, source);
  for (const auto& [name, threshold] : settings.evidence.class_thresholds)
    require(threshold >= 0.0F && threshold <= 1.0F, "{}: evidence: threshold of '{}' {}, expected 0 to 1", source, name,
            threshold);
}

constexpr const char* kPaperProfile = "paper";
constexpr const char* kRealtimeProfile = "realtime";

/// Returns the profiles that the product trains and searches by, see training/profiles.hpp.
std::vector<std::string> profile_names();

/// Returns the settings with which forests of a profile are searched. Throws InputError that lists the names for an
/// unknown name.
DetectionSettings detection_settings(const std::string& profile);

/// Returns the settings of the profile that the forest was trained with.
DetectionSettings detection_settings(const Forest& forest);

}  // namespace houghstream
