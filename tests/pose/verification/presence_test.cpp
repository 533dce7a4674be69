#include "pose/verification/presence.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "pipeline/base/random.hpp"

namespace houghstream {
namespace {

TEST(PresenceProbability, RisesWithScoreAndQualityAndStaysOne) {
  const PresenceSettings settings;
  EXPECT_GT(presence_probability(0.9F, 0.5F, settings), presence_probability(0.6F, 0.5F, settings));
  EXPECT_GT(presence_probability(0.6F, 0.9F, settings), presence_probability(0.6F, 0.5F, settings));
  EXPECT_NEAR(presence_probability(0.5F, 0.5F, settings), 1.0 / (1.0 + std::exp(-settings.bias)), 1e-6);
  for (const float end : {0.0F, 1.0F}) {
    EXPECT_GT(presence_probability(end, end, settings), 0.0F);
    EXPECT_LT(presence_probability(end, end, settings), 1.0F);
  }
}

/// There as often as `truth` says, whatever the score and the quality.
std::vector<PresenceExample> drawn_by(const PresenceSettings& truth, int count) {
  Random random(3);
  std::vector<PresenceExample> examples(static_cast<std::size_t>(count));
  for (PresenceExample& example : examples) {
    example.score = static_cast<float>(random.uniform());
    example.quality = static_cast<float>(random.uniform());
    example.is_present = random.uniform() < presence_probability(example.score, example.quality, truth);
  }
  return examples;
}

TEST(FitPresence, ManyExamplesGiveTheNumbersThatDrewThem) {
  const PresenceSettings truth{1.0, 0.5, 0.2};
  const PresenceSettings found = fit_presence(drawn_by(truth, 20000), PresenceSettings{}, 10.0);
  EXPECT_NEAR(found.bias, truth.bias, 0.06);
  EXPECT_NEAR(found.score_weight, truth.score_weight, 0.05);
  EXPECT_NEAR(found.quality_weight, truth.quality_weight, 0.05);
}

TEST(FitPresence, NoExamplesLeaveThePrior) {
  const PresenceSettings prior{1.0, 0.5, 0.2};
  const PresenceSettings found = fit_presence({}, prior, 10.0);
  EXPECT_EQ(found.bias, prior.bias);
  EXPECT_EQ(found.score_weight, prior.score_weight);
  EXPECT_EQ(found.quality_weight, prior.quality_weight);
}

}  // namespace
}  // namespace houghstream
