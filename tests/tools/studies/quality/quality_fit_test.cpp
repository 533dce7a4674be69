#include "tools/studies/quality/quality_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/random.hpp"

namespace houghstream::quality {
namespace {

const QualityTerms kWeights = terms_of({1.5, 0.5, 1.0, -0.5, 2.0, 1.0});
constexpr double kBias = -1.0;

/// Right as often as kWeights and kBias say, times `certainty`; `scenes` of equal size.
std::vector<Example> drawn(int count, int scenes, double certainty = 1.0) {
  QualitySettings truth;
  truth.bias = certainty * kBias;
  for (const auto term : kQualityTerms) truth.weights.*term = certainty * (kWeights.*term);
  Random random(7);
  std::vector<Example> examples(count);
  for (int i = 0; i < count; ++i) {
    Example& example = examples[i];
    example.scene = std::to_string(i % scenes);
    for (const auto term : kQualityTerms) example.terms.*term = random.normal();
    example.is_correct_up_to_shape = random.uniform() < static_cast<double>(shape_quality(example.terms, truth));
  }
  return examples;
}

TEST(QualityFit, TheWeightsThatDrewTheExamplesComeBackUnderTheirNames) {
  const QualitySettings found = fit_quality(drawn(20000, 5));
  EXPECT_NEAR(found.bias, kBias, 0.1);
  for (const auto term : kQualityTerms) EXPECT_NEAR(found.weights.*term, kWeights.*term, 0.1);
}

TEST(QualityFit, TypicalValuesAreTheMeansOfRightPoses) {
  std::vector<Example> examples(3);
  examples[0].terms.outline = 2.0;
  examples[0].is_correct_up_to_shape = true;
  examples[1].terms.outline = 4.0;
  examples[1].terms.texture = -1.0;
  examples[1].is_correct_up_to_shape = true;
  examples[2].terms.outline = -50.0;
  const QualityTerms mean_of_correct = fit_quality(examples).mean_of_correct;
  EXPECT_DOUBLE_EQ(mean_of_correct.outline, 3.0);
  EXPECT_DOUBLE_EQ(mean_of_correct.texture, -0.5);
  EXPECT_DOUBLE_EQ(mean_of_correct.visible, 0.0);
}

TEST(QualityFit, OneKindAloneIsRefused) {
  std::vector<Example> examples(3);
  EXPECT_THROW(fit_quality(examples), InputError);
  for (Example& example : examples) example.is_correct_up_to_shape = true;
  EXPECT_THROW(fit_quality(examples), InputError);
  EXPECT_THROW(fit_quality({}), InputError);
}

TEST(QualityFit, APoseIsCheckedByAFitThatHasNotSeenItsScene) {
  std::vector<Example> examples = drawn(4000, 4);
  for (Example& example : examples) {
    if (example.scene == "2")
      example.is_correct_up_to_shape = example.terms.outline > 0.0;  // the others do not know that
  }
  const std::vector<CheckedPose> checked = check_by_scene(examples, 4);
  ASSERT_EQ(checked.size(), examples.size());
  QualitySettings others;
  std::vector<Example> seen;
  for (const Example& example : examples) {
    if (example.scene != "2") seen.push_back(example);
  }
  others = fit_quality(seen);
  const auto first = checked.begin() + 2000;  // first example of the third part
  for (std::size_t i = 0, n = 0; i < examples.size(); ++i) {
    if (examples[i].scene != "2") continue;
    EXPECT_EQ((first + static_cast<std::ptrdiff_t>(n))->quality, shape_quality(examples[i].terms, others));
    EXPECT_EQ((first + static_cast<std::ptrdiff_t>(n++))->is_correct, examples[i].is_correct_up_to_shape);
  }
  EXPECT_THROW(check_by_scene(drawn(300, 3), 4), InputError);
}

TEST(QualityFit, TheLeastQualityIsTheFirstRoundOneFromWhichEnoughAreRight) {
  std::vector<CheckedPose> checked(98, {0.9F, true});
  checked.insert(checked.end(), 2, {0.7F, false});
  checked.insert(checked.end(), 10, {0.42F, false});
  EXPECT_EQ(min_quality(checked, 0.98), 0.45F);
  EXPECT_EQ(min_quality(checked, 0.99), 0.75F);
  EXPECT_EQ(published_from(checked, 0.7F).poses, 100);
  EXPECT_EQ(published_from(checked, 0.7F).correct, 98);
  EXPECT_TRUE(std::isnan(published_from(checked, 0.95F).correct_fraction()));
  EXPECT_EQ(min_quality({{0.9F, false}}, 0.98), std::nullopt);
}

TEST(QualityFit, ExamplesAreJudgedByTheSettingsGiven) {
  std::vector<Example> examples(2);
  examples[1].terms.outline = 3.0;
  examples[1].is_correct_up_to_shape = true;
  QualitySettings settings;
  settings.bias = 0.0;
  settings.weights = {};
  settings.weights.outline = 1.0;
  const std::vector<CheckedPose> checked = check_by(settings, examples);
  EXPECT_EQ(checked[0].quality, 0.5F);
  EXPECT_NEAR(checked[1].quality, 0.9526F, 1e-4F);
  EXPECT_TRUE(checked[1].is_correct);
  EXPECT_FALSE(checked[0].is_correct);
}

TEST(QualityFit, NumbersAreWrittenAsInitialisersAndJson) {
  EXPECT_THROW(learn_quality(drawn(8000, 4, 0.0)), InputError) << "from no quality are 98 % right";
  Learnt learnt = learn_quality(drawn(8000, 4, 10.0));
  EXPECT_EQ(std::tuple(learnt.scenes, learnt.examples), std::tuple(4, 8000));
  learnt.settings.weights = kWeights;
  learnt.settings.bias = -3.711;
  learnt.settings.min_quality = 0.6F;
  learnt.settings.mean_of_correct = {};
  EXPECT_EQ(to_initialisers(learnt.settings),
            "double bias = -3.71;\n"
            "QualityTerms weights = {1.50, 0.50, 1.00, -0.50, 2.00, 1.00, 0.00, 0.00};\n"
            "QualityTerms typical = {0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00, 0.00};\n"
            "float least = 0.60F;\n");
  const OrderedJson json = to_json(learnt);
  EXPECT_EQ(json["weights"]["chroma_conflict"], 2.0);
  EXPECT_EQ(json["weights"]["outline"], -0.5);
  EXPECT_EQ(json["published"].size(), 19U);
  EXPECT_EQ(json["published"][0]["from"], 0.05);
  EXPECT_EQ(json["least"], 0.6);
}

}  // namespace
}  // namespace houghstream::quality
