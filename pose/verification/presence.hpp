#pragma once

#include <vector>

#include "pipeline/base/settings_fields.hpp"

namespace houghstream {

/// The probability that an object is present, whether its pose is correct or not, is a logistic regression on the log
/// odds of the detection's score and of the pose's quality. These numbers are of 3108 detections in hs-teach's
/// synthetic scenes (seven objects of YCB-V, three stores). Settings that hs-teach learns of an object replace them:
/// the weight of a bad pose differs most between objects whose poses are easy and hard to estimate.
struct PresenceSettings {
  double bias = 0.27;
  double score_weight = 0.26;
  double quality_weight = 0.68;
};

template <typename Visit>
void fields(const PresenceSettings& /*settings*/, const Visit& visit) {
  using S = PresenceSettings;
  visit(number("bias", &S::bias, -1e6, 1e6));
  visit(number("of_score", &S::score_weight, -1e6, 1e6));
  visit(number("of_quality", &S::quality_weight, -1e6, 1e6));
}

/// Returns a probability in (0, 1); `score` and `quality` are in [0, 1], whose ends are not taken as certain.
float presence_probability(float score, float quality, const PresenceSettings& settings);

/// Holds a labelled detection whose pose was labelled too.
struct PresenceExample {
  float score = 0.0F;
  float quality = 0.0F;
  bool is_present = false;
};

/// Returns the settings that explain the examples best; `prior` and `precision` are as for fit_quality_settings().
PresenceSettings fit_presence(const std::vector<PresenceExample>& examples, const PresenceSettings& prior,
                              double precision);

}  // namespace houghstream
