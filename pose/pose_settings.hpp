#pragma once

#include <map>
#include <string>

#include "pose/following/follow_settings.hpp"
#include "pose/model/object_model.hpp"
#include "pose/registration/candidates.hpp"
#include "pose/registration/choice.hpp"
#include "pose/registration/registration.hpp"
#include "pose/seen/region.hpp"
#include "pose/verification/quality.hpp"
#include "pose/verification/verification.hpp"

namespace houghstream {

/// The settings of all stages, in their order; each struct stands beside its stage.
struct PoseSettings {
  ModelSettings model;
  DepthNoise noise;
  RegionSettings region;
  InitialSettings initial;
  SearchSettings search;
  WarmStartSettings warm_start;
  RegistrationSettings registration;
  TurnSettings turn;
  VerificationSettings verification;
  QualitySettings quality;
  FollowSettings follow;
  std::map<std::string, QualitySettings> class_quality;  ///< learnt for one class, by name; of the others: `quality`
  float min_score = 0.1F;                                ///< of a detection whose pose is looked for
  int threads = 1;                                       ///< any number gives the same poses
};

/// Publishes poses from this quality on, whatever their detections and their classes are.
inline void publish_from(float quality, PoseSettings& settings) {
  const auto publish = [&](QualitySettings& judged_by) { judged_by.least = judged_by.least_of_candidates = quality; };
  publish(settings.quality);
  for (auto& [name, learnt] : settings.class_quality) publish(learnt);
}

}  // namespace houghstream
