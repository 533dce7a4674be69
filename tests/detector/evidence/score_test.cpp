#include "detector/evidence/score.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "pipeline/base/random.hpp"
#include "tests/detector/listed_terms.hpp"

namespace houghstream {
namespace {

Evidence with_mass(float fraction) {
  Evidence evidence;
  evidence.relative_vote_mass = fraction;
  return evidence;
}

/// Returns a model in which other terms have no weight.
ScoreModel of_few_terms() {
  ScoreModel model;
  model.weights = {};
  model.weights.constant = 3.6F;
  model.weights.log_vote_mass = 3.0F;
  model.weights.log_visible = -1.0F;
  model.weights.free_space_violation = -4.0F;
  model.weights.rim_continuation = -2.0F;
  model.weights.colour_correlation = 2.0F;
  model.weights.hue_mismatch = -1.0F;
  return model;
}

TEST(Score, IsAProbabilityThatGrowsWithTheMass) {
  const ScoreModel model = of_few_terms();
  float last = 0.0F;
  for (const float fraction : {0.0F, 0.01F, 0.1F, 0.3F, 0.6F, 1.0F, 3.0F}) {
    const float p = score(model, with_mass(fraction));
    EXPECT_GT(p, last);
    EXPECT_LT(p, 1.0F);
    last = p;
  }
}

TEST(ScoreTerms, EachOneIsListedOnce) {
  ScoreTerms terms;
  float next = 0.0F;
  for (const auto term : kScoreTermList) terms.*term = ++next;
  const std::array<float, kScoreTerms> values = listed(terms);
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(values[i], static_cast<float>(i + 1)) << "listed twice";
  EXPECT_EQ(terms.constant, 1.0F);
  EXPECT_EQ(terms.boundary_continuation_correlation, static_cast<float>(kScoreTerms));
}

TEST(Score, WhatIsSeenThroughOrGoesOnSpeaksAgainstIt) {
  const ScoreModel model = of_few_terms();
  Evidence evidence = with_mass(0.5F);
  const float clean = score(model, evidence);
  evidence.fit.free_space_violation = 0.4F;
  EXPECT_LT(score(model, evidence), clean);
  evidence.fit.free_space_violation = 0.0F;
  evidence.fit.rim_continuation = 0.8F;
  EXPECT_LT(score(model, evidence), clean);
  evidence.fit.rim_continuation = 0.0F;
  evidence.fit.occluded_fraction = 0.5F;  // half the mass is all that can be expected then
  EXPECT_GT(score(model, evidence), clean);
}

TEST(Score, MassAndLikenessWeighOtherwiseWhereDepthIsUnknown) {
  ScoreModel model = of_few_terms();
  model.weights.no_depth_log_vote_mass = -1.0F;
  model.weights.no_depth_colour_correlation = 2.0F;
  Evidence evidence = with_mass(0.3F);
  evidence.fit.colour_correlation = 0.7F;
  const float known = score(model, evidence);
  EXPECT_EQ(known, score(of_few_terms(), evidence));
  evidence.fit.no_depth_fraction = 0.8F;  // the model without these terms ignores it
  EXPECT_GT(score(model, evidence), known);
  EXPECT_EQ(score(of_few_terms(), evidence), known);
}

TEST(Score, MissingDepthIsAnotherThingFarAway) {
  ScoreModel model = of_few_terms();
  model.weights.no_depth_distance = -2.0F;
  Evidence evidence = with_mass(0.3F);
  evidence.distance = 2.0F;
  EXPECT_EQ(score(model, evidence), score(of_few_terms(), evidence)) << "where depth is known, distance is nothing";
  evidence.fit.no_depth_fraction = 0.8F;
  const float far = score(model, evidence);
  evidence.distance = 0.4F;
  EXPECT_GT(score(model, evidence), far);
  evidence.distance = 0.0F;
  EXPECT_TRUE(std::isfinite(score_terms(evidence).no_depth_distance));
}

TEST(Score, LikenessInOtherHuesWeighsOtherwise) {
  ScoreModel model = of_few_terms();
  model.weights.colour_correlation_hue_mismatch = -3.0F;
  Evidence evidence = with_mass(0.3F);
  evidence.fit.colour_correlation = 0.7F;
  EXPECT_EQ(score(model, evidence), score(of_few_terms(), evidence));
  evidence.fit.hue_mismatch = 0.5F;
  EXPECT_LT(score(model, evidence), score(of_few_terms(), evidence));
}

TEST(Score, WhatAgreesBetterInAnotherSizeIsAnotherThing) {
  ScoreModel model = of_few_terms();
  model.weights.alternative_scale_gain = -3.0F;
  Evidence evidence = with_mass(0.3F);
  const float usual = score(model, evidence);
  evidence.alternative_scale_gain = 0.2F;
  EXPECT_LT(score(model, evidence), usual);
  EXPECT_EQ(score(of_few_terms(), evidence), score(of_few_terms(), with_mass(0.3F)));
}

TEST(Score, ManyUncertainPatchesAreLessThanFewCertainOnes) {
  ScoreModel model = of_few_terms();
  model.weights.log_certainty = 1.5F;
  Evidence evidence = with_mass(0.3F);
  evidence.certainty = 2.0F;
  const float certain = score(model, evidence);
  evidence.certainty = 0.5F;
  EXPECT_LT(score(model, evidence), certain);
  evidence.certainty = 0.0F;
  EXPECT_TRUE(std::isfinite(score_terms(evidence).log_certainty));
}

TEST(Score, WhatIsMuchHiddenOrAgreesMuchBetterInAnotherSizeWeighsMoreThanItsShare) {
  const auto change = [](float ScoreTerms::*term,
                         const auto& set) {  // log odds of the score per unit of the term's weight
    ScoreModel model = of_few_terms();
    model.weights.*term = 1.0F;
    Evidence evidence = with_mass(0.3F);
    evidence.alternative_scale_gain = 0.0F;
    set(evidence);
    const auto odds = [&](const ScoreModel& m) { return std::log(score(m, evidence) / (1.0F - score(m, evidence))); };
    return odds(model) - odds(of_few_terms());
  };
  EXPECT_NEAR(change(&ScoreTerms::log_visible_sq, [](Evidence& e) { e.fit.occluded_fraction = 0.52F; }),
              std::log(2.0F) * std::log(2.0F), 1e-3F);
  EXPECT_NEAR(change(&ScoreTerms::alternative_scale_gain_sq, [](Evidence& e) { e.alternative_scale_gain = -0.4F; }),
              0.16F, 1e-3F);
  EXPECT_NEAR(change(&ScoreTerms::depth_residual_sq, [](Evidence& e) { e.fit.depth_residual = 0.5F; }), 0.25F, 1e-3F);
}

TEST(Score, WhatIsSeenThroughWeighsByTheCertaintyAndHuesByTheForeignColour) {
  ScoreModel model = of_few_terms();
  model.weights.free_space_violation_log_certainty = 1.0F;
  model.weights.hue_mismatch_chroma_distance = -1.0F;
  Evidence evidence = with_mass(0.3F);
  evidence.certainty = 2.0F;
  evidence.fit.hue_mismatch = 0.5F;
  EXPECT_EQ(score(model, evidence), score(of_few_terms(), evidence)) << "nothing is seen through, no colour is foreign";
  evidence.fit.free_space_violation = 0.3F;
  EXPECT_GT(score(model, evidence), score(of_few_terms(), evidence));
  evidence.fit.free_space_violation = 0.0F;
  evidence.fit.mean_chroma_distance = 0.8F;
  EXPECT_LT(score(model, evidence), score(of_few_terms(), evidence));
}

/// Returns examples whose outcome is drawn from a model.
std::vector<ScoreExample> drawn_from(const ScoreModel& truth, int count) {
  Random random(4);
  std::vector<ScoreExample> examples;
  for (int i = 0; i < count; ++i) {
    Evidence evidence = with_mass(static_cast<float>(std::exp(random.uniform(-4.0, 0.5))));
    evidence.fit.occluded_fraction = static_cast<float>(random.uniform(0.0, 0.8));
    evidence.fit.free_space_violation = static_cast<float>(random.uniform(0.0, 0.5));
    evidence.fit.no_depth_fraction = static_cast<float>(random.uniform(0.0, 0.5));
    evidence.fit.rim_continuation = static_cast<float>(random.uniform(0.0, 1.0));
    evidence.fit.colour_correlation = static_cast<float>(random.uniform(-0.2, 1.0));
    evidence.fit.hue_mismatch = static_cast<float>(random.uniform(0.0, 1.0));
    evidence.fit.mean_chroma_distance = static_cast<float>(random.uniform(0.0, 2.0));
    evidence.alternative_scale_gain = static_cast<float>(random.uniform(-1.0, 0.3));
    evidence.certainty = static_cast<float>(std::exp(random.uniform(-1.0, 1.0)));
    examples.push_back({score_terms(evidence), random.uniform() < score(truth, evidence)});
  }
  return examples;
}

TEST(Score, TheModelThatMadeTheExamplesComesBack) {
  ScoreModel truth;
  truth.weights = {};
  constexpr float kWeights[] = {2.0F, 2.5F, -2.0F, -3.0F, 0.5F, -1.5F, 3.0F, -1.2F};
  for (std::size_t i = 0; i < std::size(kWeights); ++i) truth.weights.*kScoreTermList[i] = kWeights[i];
  const ScoreModel fitted = fit_score_model(drawn_from(truth, 40000), {ScoreTerms{}});
  for (std::size_t i = 0; i < kScoreTerms; ++i)
    EXPECT_NEAR(listed(fitted.weights)[i], listed(truth.weights)[i], 0.35F) << i;
}

TEST(Score, ExamplesThatAreToldApartWithoutErrorMoveTheWeightsOnlySoFar) {
  std::vector<ScoreExample> examples;
  for (int i = 0; i < 400; ++i) {
    Evidence evidence = with_mass(i % 2 == 0 ? 1.0F : 0.001F);
    examples.push_back({score_terms(evidence), i % 2 == 0});
  }
  const ScoreModel fitted = fit_score_model(examples, ScoreModel{});
  for (const float weight : listed(fitted.weights)) EXPECT_LT(std::abs(weight), 20.0F);
  EXPECT_GT(score(fitted, with_mass(1.0F)), 0.95F);
  EXPECT_LT(score(fitted, with_mass(0.001F)), 0.05F);
}

TEST(Score, WithoutExamplesThePriorStays) {
  ScoreModel prior;
  prior.weights = {};
  for (std::size_t i = 0; i < 8; ++i) prior.weights.*kScoreTermList[i] = static_cast<float>(i + 1);
  EXPECT_EQ(listed(fit_score_model({}, prior).weights), listed(prior.weights));
}

TEST(Score, SeparableExamplesGiveFiniteWeights) {
  std::vector<ScoreExample> examples;
  examples.reserve(50);
  for (int i = 0; i < 50; ++i) examples.push_back({score_terms(with_mass(i < 25 ? 0.01F : 1.0F)), i >= 25});
  for (const float weight : listed(fit_score_model(examples, ScoreModel{}).weights)) EXPECT_LT(std::abs(weight), 20.0F);
}

}  // namespace
}  // namespace houghstream
