#include "pose/verification/presence.hpp"

#include "pipeline/base/logistic_regression.hpp"
#include "pipeline/base/logit.hpp"

namespace houghstream {
namespace {

using PresenceWeights = Eigen::Vector3d;

PresenceWeights terms_of(float score, float quality) {
  return {1.0, logit(static_cast<double>(score)), logit(static_cast<double>(quality))};
}

PresenceWeights weights_of(const PresenceSettings& settings) {
  return {settings.bias, settings.score_weight, settings.quality_weight};
}

}  // namespace

float presence_probability(float score, float quality, const PresenceSettings& settings) {
  return static_cast<float>(logistic(weights_of(settings).dot(terms_of(score, quality))));
}

PresenceSettings fit_presence(const std::vector<PresenceExample>& examples, const PresenceSettings& prior,
                              double precision) {
  std::vector<LogisticExample<3>> labelled;
  labelled.reserve(examples.size());
  for (const PresenceExample& example : examples)
    labelled.push_back({terms_of(example.score, example.quality), example.is_present});
  const PresenceWeights weights = fit_logistic<3>(labelled, {weights_of(prior), precision});
  return {weights[0], weights[1], weights[2]};
}

}  // namespace houghstream
