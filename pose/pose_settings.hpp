#pragma once

#include <map>
#include <string>

#include "pipeline/base/check_settings.hpp"
#include "pipeline/base/settings_fields.hpp"
#include "pose/model/object_model.hpp"
#include "pose/registration/candidates.hpp"
#include "pose/registration/pose_selection.hpp"
#include "pose/registration/registration.hpp"
#include "pose/seen/region.hpp"
#include "pose/verification/quality.hpp"
#include "pose/verification/verification.hpp"

namespace houghstream {

/// Holds the settings of all stages, in their order; each struct is declared beside its stage.
struct PoseSettings {
  ModelSettings model;
  DepthNoise noise;
  RegionSettings region;
  InitialSettings initial;
  SearchSettings search;
  WarmStartSettings warm_start;
  RegistrationSettings registration;
  RotationSearchSettings rotation_search;
  VerificationSettings verification;
  bool learn_camera_colours = true;  ///< models are brought to the camera's colours before their chroma is compared
  bool compare_instances = true;     ///< poses of one class in a frame are compared in chroma (compare_with_instance)
  QualitySettings quality;
  std::map<std::string, QualitySettings> class_quality;  ///< learnt for one class, by name; of the others: `quality`
  float min_score = 0.1F;                                ///< minimum score of a detection whose pose is estimated
  /// Candidates whose pose is less likely to be published than this (publication_probability) are given up before the
  /// search among their rotations, which takes most of a pose's time. Chosen: of 251 poses that were published in
  /// furnished rooms none was less likely than 0.02; a third of the others was less likely than 0.01.
  float min_publication_probability = 0.01F;
  /// Candidates that lie by more than this fraction of their visible points on the surface of objects whose poses are
  /// published already (ExplainedSurface) are given up at the same place. Chosen: of 30 candidates that were published
  /// in furnished rooms and on YCB-V none lay by more than 0 there, but for the double of a mustard bottle.
  float max_explained_surface = 0.6F;
  double duplicate_distance_ratio = 0.5;  ///< distance over the smaller radius, below which two of a class are one
  /// Fraction of the smaller surface that two classes explain in common (shared_surface), above which they are one
  /// object. Chosen: faces of equal boxes share all of it, things that touch nothing.
  float max_shared_surface = 0.5F;
  int threads = 1;  ///< any number gives the same poses
};

template <typename Visit>
void fields(const PoseSettings& /*settings*/, const Visit& visit) {
  using S = PoseSettings;
  visit(group("model", &S::model));
  visit(group("noise", &S::noise));
  visit(group("region", &S::region));
  visit(group("initial", &S::initial));
  visit(group("search", &S::search));
  visit(group("warm_start", &S::warm_start));
  visit(group("registration", &S::registration));
  visit(group("rotation_search", &S::rotation_search));
  visit(group("verification", &S::verification));
  visit(group("quality", &S::quality));
  visit(number("min_score", &S::min_score, 0, 1));
  visit(number("min_publication_probability", &S::min_publication_probability, 0, 1));
  visit(number("max_explained_surface", &S::max_explained_surface, 0, 1));
  visit(number("duplicate_distance_ratio", &S::duplicate_distance_ratio, 0, 10));
  visit(number("max_shared_surface", &S::max_shared_surface, 0, 1));
  visit(number("threads", &S::threads, 1, 256));
}

/// Checks the settings as described in pipeline/base/check_settings.hpp, and the qualities of single classes too.
inline void check_settings(const PoseSettings& settings, const std::string& source) {
  check_fields(settings, source);
  for (const auto& [name, quality] : settings.class_quality)
    check_settings(quality, fmt::format("{}: quality of '{}'", source, name));
}

/// Returns the quality that a class' poses are judged by: the one learnt for it, or the common one.
inline const QualitySettings& class_quality_of(const PoseSettings& settings, const std::string& class_name) {
  const auto learnt = settings.class_quality.find(class_name);
  return learnt != settings.class_quality.end() ? learnt->second : settings.quality;
}

/// Returns the settings of all stages that the choice among registered candidates reads.
inline PoseSelectionSettings pose_selection_settings(const PoseSettings& settings) {
  PoseSelectionSettings selection;
  selection.initial = settings.initial;
  selection.registration = settings.registration;
  selection.rotation_search = settings.rotation_search;
  selection.tolerance_m = settings.verification.tolerance_m;
  return selection;
}

/// Publishes poses from this quality on, whatever their detections and their classes are.
inline void set_min_quality(float quality, PoseSettings& settings) {
  const auto publish = [&](QualitySettings& judged_by) {
    judged_by.min_quality = judged_by.min_candidate_quality = quality;
  };
  publish(settings.quality);
  for (auto& [name, learnt] : settings.class_quality) publish(learnt);
}

}  // namespace houghstream
