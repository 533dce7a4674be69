#include "pose/verification/quality_training.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "pipeline/base/logit.hpp"
#include "pipeline/base/random.hpp"

namespace houghstream {
namespace {

const QualityTerms kWeights = terms_of({1.5, 0.5, 1.0, -0.5, 2.0, 1.0});
constexpr double kBias = -1.0;

/// Right as often as kWeights and kBias say.
std::vector<QualityExample> drawn(int count) {
  QualitySettings truth;
  truth.bias = kBias;
  truth.weights = kWeights;
  Random random(7);
  std::vector<QualityExample> examples(static_cast<std::size_t>(count));
  for (QualityExample& example : examples) {
    for (const auto term : kQualityTerms) example.terms.*term = random.normal();
    example.is_correct_up_to_shape = random.uniform() < static_cast<double>(shape_quality(example.terms, truth));
  }
  return examples;
}

TEST(QualityTraining, ManyExamplesGiveTheWeightsThatDrewThem) {
  const QualitySettings found = fit_quality_settings(drawn(20000), QualitySettings{}, 1.0);
  EXPECT_NEAR(found.bias, kBias, 0.1);
  for (const auto term : kQualityTerms) EXPECT_NEAR(found.weights.*term, kWeights.*term, 0.1);
}

/// Returns the distance of the weights from the default ones.
double way_from_prior(const QualitySettings& settings) {
  const QualitySettings prior;
  double sum_sq = (settings.bias - prior.bias) * (settings.bias - prior.bias);
  for (const auto term : kQualityTerms) {
    const double way = settings.weights.*term - prior.weights.*term;
    sum_sq += way * way;
  }
  return std::sqrt(sum_sq);
}

TEST(QualityTraining, FewExamplesLeaveThePriorLittle) {
  const double by_few = way_from_prior(fit_quality_settings(drawn(3), QualitySettings{}, 1.0));
  EXPECT_GT(by_few, 0.0);
  EXPECT_LT(by_few, 0.4 * way_from_prior(fit_quality_settings(drawn(20000), QualitySettings{}, 1.0)));
  EXPECT_LT(way_from_prior(fit_quality_settings(drawn(3), QualitySettings{}, 100.0)), 0.1 * by_few);
}

TEST(QualityTraining, AnotherTextureMovesTheWeightsOfColourBeyondAllOthers) {
  std::vector<QualityExample> examples = drawn(2000);
  const QualitySettings alone = fit_quality_settings(examples, QualitySettings{}, 1.0);
  for (QualityExample& example : examples) {
    if (!example.is_correct_up_to_shape) continue;
    example.with_swapped_texture = example.terms;
    example.with_swapped_texture->texture = example.terms.texture - 0.3;
  }
  const QualitySettings told_apart = fit_quality_settings(examples, QualitySettings{}, 1.0);
  EXPECT_GT(told_apart.weights.texture, alone.weights.texture + 0.5);
  EXPECT_NEAR(told_apart.weights.outline, alone.weights.outline, 0.25);
}

TEST(QualityTraining, WhatIsSeenThroughWeighsAsItDid) {
  std::vector<QualityExample> examples = drawn(2000);
  for (QualityExample& example : examples)
    example.terms.free_space_violation = example.is_correct_up_to_shape ? -1.0 : 1.0;
  QualitySettings prior;
  EXPECT_EQ(fit_quality_settings(examples, prior, 1.0).weights.free_space_violation,
            prior.weights.free_space_violation);
}

TEST(QualityTraining, NoExamplesGiveThePrior) {
  QualitySettings prior;
  prior.bias = 0.5;
  prior.weights.outline = 3.0;
  prior.mean_of_correct.outline = 7.0;
  const QualitySettings found = fit_quality_settings({}, prior, 1.0);
  EXPECT_DOUBLE_EQ(found.bias, 0.5);
  for (const auto term : kQualityTerms) {
    EXPECT_DOUBLE_EQ(found.weights.*term, prior.weights.*term);
    EXPECT_DOUBLE_EQ(found.mean_of_correct.*term, prior.mean_of_correct.*term);
  }
}

TEST(QualityTraining, TypicalValuesAreTheMeansOfRightPosesAndTheLeastQualityIsThePriors) {
  std::vector<QualityExample> examples(3);
  examples[0].terms.outline = 2.0;
  examples[0].is_correct_up_to_shape = true;
  examples[1].terms.outline = 4.0;
  examples[1].is_correct_up_to_shape = true;
  examples[2].terms.outline = -2.0;
  QualitySettings prior;
  prior.min_quality = 0.77F;
  const QualitySettings found = fit_quality_settings(examples, prior, 1.0);
  EXPECT_DOUBLE_EQ(found.mean_of_correct.outline, 3.0);
  EXPECT_DOUBLE_EQ(found.mean_of_correct.visible, 0.0);
  EXPECT_EQ(found.min_quality, 0.77F);
  const QualitySettings none_right = fit_quality_settings({examples[2]}, prior, 1.0);
  EXPECT_DOUBLE_EQ(none_right.mean_of_correct.outline, prior.mean_of_correct.outline);
  EXPECT_LT(none_right.bias, prior.bias) << "a wrong pose speaks against all";
}

/// Makes equal examples in both halves. The object is present where the pose is correct, and in a fraction
/// `there_anyway` of the other cases.
std::vector<QualityExample> calibrated(double there_anyway) {
  std::vector<QualityExample> examples = drawn(600);
  Random random(11);
  for (QualityExample& example : examples) {
    example.score = 0.5F;
    example.is_present = example.is_correct_up_to_shape || random.uniform() < there_anyway;
  }
  const std::vector<QualityExample> again = examples;
  examples.insert(examples.end(), again.begin(), again.end());
  for (std::size_t i = again.size(); i < examples.size(); ++i) examples[i].fold = 1;
  return examples;
}

/// Poses that are right up to their shape, with margins drawn evenly; which is right is decided by `weight` and `bias`.
std::vector<QualityExample> with_texture(double bias, double weight) {
  std::vector<QualityExample> examples(2000);
  Random random(5);
  for (QualityExample& example : examples) {
    example.is_correct_up_to_shape = example.is_present = true;
    example.texture_margin = -4.0 + 8.0 * random.uniform();
    example.is_correct = random.uniform() < logistic(bias + weight * *example.texture_margin);
  }
  return examples;
}

TEST(FitTextureSettings, LearnsWhatAMarginIsWorth) {
  const TextureSettings found = fit_texture_settings(with_texture(1.0, 0.5), TextureSettings{}, 1.0);
  EXPECT_NEAR(found.bias, 1.0, 0.2);
  EXPECT_NEAR(found.margin_weight, 0.5, 0.1);
}

TEST(FitTextureSettings, LooksOnlyAtPosesThatAreRightUpToTheirShapeAndHaveAlternatives) {
  std::vector<QualityExample> examples = with_texture(1.0, 0.5);
  const TextureSettings found = fit_texture_settings(examples, TextureSettings{}, 1.0);
  QualityExample other;
  other.texture_margin = 3.0;
  examples.insert(examples.end(), 500, other);  // wrong by its shape
  other.is_correct_up_to_shape = true;
  other.texture_margin.reset();
  examples.insert(examples.end(), 500, other);
  const TextureSettings again = fit_texture_settings(examples, TextureSettings{}, 1.0);
  EXPECT_EQ(again.bias, found.bias);
  EXPECT_EQ(again.margin_weight, found.margin_weight);
  const TextureSettings prior{0.3, 0.7};
  EXPECT_EQ(fit_texture_settings({other}, prior, 1.0).bias, prior.bias) << "of no example comes the prior";
}

TEST(TextureProbability, IsNeverCertain) {
  for (const double margin : {-1e6, 0.0, 1e6}) {
    const float probability = texture_probability(margin, {});
    EXPECT_GT(probability, 0.0F) << margin;
    EXPECT_LT(probability, 1.0F) << margin;
  }
  EXPECT_EQ(texture_probability(0.0, {}), 0.5F);
}

TEST(LearnQualities, WhatAMarginIsWorthIsEachObjectsOwn) {
  const std::map<std::string, QualitySettings> learnt =
      learn_qualities({{"printed", with_texture(0.0, 2.0)}, {"plain", with_texture(0.0, 0.1)}});
  EXPECT_GT(learnt.at("printed").texture.margin_weight, 1.5);
  EXPECT_LT(learnt.at("plain").texture.margin_weight, 0.3);
}

TEST(LearnQualities, WhatABadPoseSaysOfPresenceIsEachObjectsOwn) {
  const std::map<std::string, QualitySettings> learnt =
      learn_qualities({{"easily posed", calibrated(0.0)}, {"hardly posed", calibrated(0.8)}});
  ASSERT_EQ(learnt.size(), 2U);
  EXPECT_LT(presence_probability(0.5F, 0.02F, learnt.at("easily posed").presence), 0.2F);
  EXPECT_GT(presence_probability(0.5F, 0.02F, learnt.at("hardly posed").presence), 0.5F);
}

TEST(LearnQualities, PresenceIsLearntFromQualitiesThatDidNotKnowTheExamples) {
  // In one fold the first term shows that a pose is correct, in the other one that it is wrong: the settings of one
  // fold then contradict the other, which a quality fitted to both would not.
  std::vector<QualityExample> examples(400);
  for (std::size_t i = 0; i < examples.size(); ++i) {
    QualityExample& example = examples[i];
    example.fold = i < examples.size() / 2 ? 0 : 1;
    example.is_correct_up_to_shape = example.is_present = i % 2 == 0;
    example.score = 0.5F;
    example.terms.detection_logit = example.is_correct_up_to_shape == (example.fold == 0) ? 1.0 : -1.0;
  }
  EXPECT_LT(learn_qualities({{"mug", examples}}).at("mug").presence.quality_weight, 0.0);
}

}  // namespace
}  // namespace houghstream
