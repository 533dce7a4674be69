#include "detector/evidence/score.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "pipeline/random.hpp"

namespace houghstream {
namespace {

/// Measures in the order of score_terms; the constant is term 0.
enum Measure : std::size_t { kMass = 1, kNotHidden, kSeenThrough, kUnknown, kContinued, kLikeness, kHueConflict };
constexpr std::size_t kOtherSize = 10;
constexpr std::size_t kCertainty = 11;
constexpr std::size_t kUnknownFarAway = 12;

/// Where score_terms() has the product of two measures, the first not behind the second.
std::size_t product_of(std::size_t a, std::size_t b) {
  std::size_t at = kScoreMeasures + 2;
  for (std::size_t before = 1; before < a; ++before) at += kScoreMeasures + 1 - before;
  return at + b - a;
}

Evidence with_mass(float share) {
  Evidence evidence;
  evidence.mass_share = share;
  return evidence;
}

TEST(Score, IsAProbabilityThatGrowsWithTheMass) {
  const ScoreModel model;
  float last = 0.0F;
  for (const float share : {0.0F, 0.01F, 0.1F, 0.3F, 0.6F, 1.0F, 3.0F}) {
    const float p = score(model, with_mass(share));
    EXPECT_GT(p, last);
    EXPECT_LT(p, 1.0F);
    last = p;
  }
}

TEST(Score, WhatIsSeenThroughOrGoesOnSpeaksAgainstIt) {
  const ScoreModel model;
  Evidence evidence = with_mass(0.5F);
  const float clean = score(model, evidence);
  evidence.fit.seen_through = 0.4F;
  EXPECT_LT(score(model, evidence), clean);
  evidence.fit.seen_through = 0.0F;
  evidence.fit.continued = 0.8F;
  EXPECT_LT(score(model, evidence), clean);
  evidence.fit.continued = 0.0F;
  evidence.fit.hidden = 0.5F;  // half the mass is all that can be expected then
  EXPECT_GT(score(model, evidence), clean);
}

TEST(Score, MassAndLikenessWeighOtherwiseWhereDepthIsUnknown) {
  ScoreModel model;
  model.weights[product_of(kMass, kUnknown)] = -1.0F;
  model.weights[product_of(kUnknown, kLikeness)] = 2.0F;
  Evidence evidence = with_mass(0.3F);
  evidence.fit.likeness = 0.7F;
  const float known = score(model, evidence);
  EXPECT_EQ(known, score(ScoreModel{}, evidence));
  evidence.fit.unknown = 0.8F;  // of which the model without these terms makes nothing
  EXPECT_GT(score(model, evidence), known);
  EXPECT_EQ(score(ScoreModel{}, evidence), known);
}

TEST(Score, EveryTwoMeasuresHaveTheirProductAndEachItsSquare) {
  Evidence evidence = with_mass(0.3F);
  evidence.fit = {0.4F, 0.2F, 0.1F, 0.3F, 0.25F, 0.15F, 0.7F, 0.9F, 0.35F, {}};
  evidence.certainty = 1.7F;
  const ScoreTerms terms = score_terms(evidence);
  for (std::size_t a = 1; a <= kScoreMeasures; ++a) {
    for (std::size_t b = a; b <= kScoreMeasures; ++b) EXPECT_EQ(terms[product_of(a, b)], terms[a] * terms[b]);
  }
  EXPECT_EQ(product_of(kScoreMeasures, kScoreMeasures), kScoreTerms - 1);
}

TEST(Score, ABandOfAMeasureCanSpeakForAnObjectWhereMoreAndLessSpeakAgainstIt) {
  Random random(8);
  std::vector<ScoreExample> examples;
  for (int i = 0; i < 600; ++i) {
    Evidence evidence = with_mass(0.3F);
    evidence.fit.likeness = static_cast<float>(random.uniform(-1.0, 1.0));
    examples.push_back({score_terms(evidence), std::abs(evidence.fit.likeness - 0.2F) < 0.3F});
  }
  const ScoreModel fitted = fit_score_model(examples, ScoreModel{});
  const auto at = [&](float likeness) {
    Evidence evidence = with_mass(0.3F);
    evidence.fit.likeness = likeness;
    return score(fitted, evidence);
  };
  EXPECT_GT(at(0.2F), 0.7F);
  EXPECT_LT(at(-0.4F), 0.3F);
  EXPECT_LT(at(0.8F), 0.3F);
}

TEST(Score, MissingDepthIsAnotherThingFarAway) {
  ScoreModel model;
  model.weights[kUnknownFarAway] = -2.0F;
  Evidence evidence = with_mass(0.3F);
  evidence.distance = 2.0F;
  EXPECT_EQ(score(model, evidence), score(ScoreModel{}, evidence)) << "where depth is known, distance is nothing";
  evidence.fit.unknown = 0.8F;
  const float far = score(model, evidence);
  evidence.distance = 0.4F;
  EXPECT_GT(score(model, evidence), far);
  evidence.distance = 0.0F;
  EXPECT_TRUE(std::isfinite(score_terms(evidence)[kUnknownFarAway]));
}

TEST(Score, LikenessInOtherHuesWeighsOtherwise) {
  ScoreModel model;
  model.weights[product_of(kLikeness, kHueConflict)] = -3.0F;
  Evidence evidence = with_mass(0.3F);
  evidence.fit.likeness = 0.7F;
  EXPECT_EQ(score(model, evidence), score(ScoreModel{}, evidence));
  evidence.fit.hue_conflict = 0.5F;
  EXPECT_LT(score(model, evidence), score(ScoreModel{}, evidence));
}

TEST(Score, WhatAgreesBetterInAnotherSizeIsAnotherThing) {
  ScoreModel model;
  model.weights[kOtherSize] = -3.0F;
  Evidence evidence = with_mass(0.3F);
  const float usual = score(model, evidence);
  evidence.other_size = 0.2F;
  EXPECT_LT(score(model, evidence), usual);
  EXPECT_EQ(score(ScoreModel{}, evidence), score(ScoreModel{}, with_mass(0.3F)));
}

TEST(Score, ManyUncertainPatchesAreLessThanFewCertainOnes) {
  ScoreModel model;
  model.weights[kCertainty] = 1.5F;
  Evidence evidence = with_mass(0.3F);
  evidence.certainty = 2.0F;
  const float certain = score(model, evidence);
  evidence.certainty = 0.5F;
  EXPECT_LT(score(model, evidence), certain);
  evidence.certainty = 0.0F;
  EXPECT_TRUE(std::isfinite(score_terms(evidence)[kCertainty]));
}

/// Examples whose truth is drawn from a model.
std::vector<ScoreExample> drawn_from(const ScoreModel& truth, int count) {
  Random random(4);
  std::vector<ScoreExample> examples;
  for (int i = 0; i < count; ++i) {
    Evidence evidence = with_mass(static_cast<float>(std::exp(random.uniform(-4.0, 0.5))));
    evidence.fit.hidden = static_cast<float>(random.uniform(0.0, 0.8));
    evidence.fit.seen_through = static_cast<float>(random.uniform(0.0, 0.5));
    evidence.fit.unknown = static_cast<float>(random.uniform(0.0, 0.5));
    evidence.fit.continued = static_cast<float>(random.uniform(0.0, 1.0));
    evidence.fit.likeness = static_cast<float>(random.uniform(-0.2, 1.0));
    evidence.fit.foreign_colour = static_cast<float>(random.uniform(0.0, 2.0));
    evidence.other_size = static_cast<float>(random.uniform(-1.0, 0.3));
    evidence.certainty = static_cast<float>(std::exp(random.uniform(-1.0, 1.0)));
    examples.push_back({score_terms(evidence), random.uniform() < score(truth, evidence)});
  }
  return examples;
}

TEST(Score, TheModelThatMadeTheExamplesComesBack) {
  ScoreModel truth;
  truth.weights = {2.0F, 2.5F, -2.0F, -3.0F, 0.5F, -1.5F, 3.0F, -1.2F};
  truth.weights[product_of(kLikeness, kLikeness)] = 1.5F;
  truth.weights[product_of(kMass, kContinued)] = -1.0F;
  const ScoreModel fitted = fit_score_model(drawn_from(truth, 40000), ScoreModel{});
  for (const ScoreExample& example : drawn_from(truth, 400)) {  // measures and products make up for each other
    double expected = 0.0;
    double got = 0.0;
    for (std::size_t i = 0; i < kScoreTerms; ++i) {
      expected += truth.weights[i] * example.terms[i];
      got += fitted.weights[i] * example.terms[i];
    }
    EXPECT_NEAR(1.0 / (1.0 + std::exp(-got)), 1.0 / (1.0 + std::exp(-expected)), 0.08);
  }
}

TEST(Score, ExamplesThatAreToldApartWithoutErrorMoveTheWeightsOnlySoFar) {
  std::vector<ScoreExample> examples;
  for (int i = 0; i < 400; ++i) {
    Evidence evidence = with_mass(i % 2 == 0 ? 1.0F : 0.001F);
    examples.push_back({score_terms(evidence), i % 2 == 0});
  }
  const ScoreModel fitted = fit_score_model(examples, ScoreModel{});
  for (const float weight : fitted.weights) EXPECT_LT(std::abs(weight), 20.0F);
  EXPECT_GT(score(fitted, with_mass(1.0F)), 0.95F);
  EXPECT_LT(score(fitted, with_mass(0.001F)), 0.05F);
}

TEST(Score, WithoutExamplesThePriorStays) {
  const ScoreModel prior{{1.0F, 2.0F, 3.0F, 4.0F, 5.0F, 6.0F, 7.0F, 8.0F}};
  EXPECT_EQ(fit_score_model({}, prior).weights, prior.weights);
}

TEST(Score, SeparableExamplesGiveFiniteWeights) {
  std::vector<ScoreExample> examples;
  examples.reserve(50);
  for (int i = 0; i < 50; ++i) examples.push_back({score_terms(with_mass(i < 25 ? 0.01F : 1.0F)), i >= 25});
  for (const float weight : fit_score_model(examples, ScoreModel{}).weights) EXPECT_LT(std::abs(weight), 20.0F);
}

}  // namespace
}  // namespace houghstream
