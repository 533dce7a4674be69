#pragma once

#include <algorithm>
#include <map>
#include <string>

#include "pipeline/base/settings_fields.hpp"

namespace houghstream {

/// Limits of what is reported, or handed on as a candidate.
struct EvidenceSettings {
  /// Smallest score that is reported. In the rendered rooms development_world_20 to 67 (hs-render) 95 % of the
  /// detections from 0.60 on are true.
  float threshold = 0.65F;
  std::map<std::string, float> class_thresholds{};  ///< threshold of one class, by name; of the others: `threshold`
  /// Minimum score of a candidate, a detection for a pose to confirm (Detection::reported); 1 disables candidates.
  float candidates_from = 1.0F;
  int max_candidates = 16;  ///< the strongest; a frame full of weak maxima must not hold up the poses of the others
  /// Maximum number of hypotheses of a frame that are compared with view templates: those with the highest
  /// vote_logit(). Frames with up to 13 objects never have more. It was chosen on 88 images of furnished rooms: of 21
  /// objects' hypotheses the first 80 held 257 of 260 objects, the first 160 all.
  int max_compared = 160;
  /// Maximum number of hypotheses that are also compared with views of all attitudes (ForestIndex::sampled_views),
  /// besides the likely ones: those with the highest vote_logit() among those with many votes. The first 48 held all
  /// but a few of 454 objects that were found in furnished rooms and on YCB-V, with 21 to 60 taught; these few were
  /// likely already.
  int max_sampled = 48;
  int max_refined = 64;  ///< maximum number of compared hypotheses whose templates are refined, highest scores first
  /// A hypothesis with at least this score explains the surface that it shows: others there are dropped
  /// (UnoccludedCells). A value above 1 disables this.
  float explains_from = 0.9F;
  int max_rotations = 48;  ///< rotations handed to the pose process
  /// Views are mapped to the camera's colours (camera_chroma.hpp). Scores are learnt without it: rendered images have
  /// the models' own colours.
  bool learn_camera_colours = true;

  /// Returns the smallest score of this class that is reported.
  float threshold_of(const std::string& class_name) const {
    const auto known = class_thresholds.find(class_name);
    return known != class_thresholds.end() ? known->second : threshold;
  }

  /// Returns the smallest score of this class that is reported or handed on as a candidate.
  float min_kept_score(const std::string& class_name) const {
    return std::min(threshold_of(class_name), candidates_from);
  }
};

template <typename Visit>
void fields(const EvidenceSettings& /*settings*/, const Visit& visit) {
  using S = EvidenceSettings;
  visit(number("threshold", &S::threshold, 0, 1));
  visit(number("candidates_from", &S::candidates_from, 0, 1));
  visit(number("max_candidates", &S::max_candidates, 0, 1000000));
  visit(number("max_compared", &S::max_compared, 1, 1000000));
  visit(number("max_sampled", &S::max_sampled, 0, 1000000));
  visit(number("max_refined", &S::max_refined, 0, 1000000));
  visit(number("explains_from", &S::explains_from, 0, 2));
  visit(number("max_rotations", &S::max_rotations, 0, 1000000));
}

/// Settings that decide which of two overlapping detections stays (non-maximum suppression).
struct SuppressionSettings {
  float max_overlap = 0.5F;  ///< a weaker box of another object may overlap a stronger one by this IoU
  /// A weaker detection of another class is suppressed if the stronger one's score is above 0.5 and this many times as
  /// high. One of its own class is always suppressed.
  float dominance = 2.0F;
};

template <typename Visit>
void fields(const SuppressionSettings& /*settings*/, const Visit& visit) {
  using S = SuppressionSettings;
  visit(number("max_overlap", &S::max_overlap, 0, 1));
  visit(number("dominance", &S::dominance, 0, 1e6));
}

}  // namespace houghstream
