#include "detector/training/split_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "tests/detector/planted_set.hpp"

namespace houghstream::training {
namespace {

std::vector<std::uint32_t> every_sample(const TrainingSet& set) {
  std::vector<std::uint32_t> samples(set.samples.size());
  for (std::uint32_t i = 0; i < samples.size(); ++i) samples[i] = i;
  return samples;
}

bool goes_right(const TrainingSet& set, const PixelTest& test, const TrainingSample& sample) {
  return test_value(test, set.patch(sample)) >= test.threshold;
}

std::optional<PixelTest> search(const TrainingSet& set, const std::vector<std::uint32_t>& samples, Objective objective,
                                std::uint64_t seed) {
  const PatchSettings patch;
  TrainingSettings settings;
  settings.tests_per_node = 800;
  Random random(seed);
  return SplitSearch(set, patch, settings, {1.0F, 1.0F}, true).best_test(samples, objective, random);
}

TEST(SplitSearch, FindsThePlaneThatSeparatesTheLabels) {
  const TrainingSet set = toy::planted_set();
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto test = search(set, every_sample(set), Objective::kClass, seed);
    ASSERT_TRUE(test);
    EXPECT_EQ(test->plane, toy::kClassPlane);
    const bool object_side = goes_right(set, *test, set.samples[50]);
    for (const TrainingSample& sample : set.samples) {
      ASSERT_EQ(goes_right(set, *test, sample), (sample.label != 0) == object_side);
    }
  }
}

TEST(SplitSearch, FindsThePlaneThatSeparatesTheOffsets) {
  const TrainingSet set = toy::planted_set();
  const auto test = search(set, every_sample(set), Objective::kOffset, 1);
  ASSERT_TRUE(test);
  EXPECT_EQ(test->plane, toy::kOffsetPlane);
}

TEST(SplitSearch, WhereAllValuesAreEqualThereIsNoTest) {
  toy::Planted planted = toy::plant();
  for (FeatureImage& image : planted.images) image = FeatureImage(32, 32, planted.set.layout.pixel_stride());
  const TrainingSet set = toy::set_of(planted);
  EXPECT_FALSE(search(set, every_sample(set), Objective::kClass, 1));
  EXPECT_FALSE(search(set, every_sample(set), Objective::kOffset, 1));
}

TEST(SplitSearch, BothSidesKeepEnoughSamples) {
  const TrainingSet set = toy::planted_set();
  std::vector<std::uint32_t> few;
  few.reserve(59);
  for (std::uint32_t i = 0; i < 9; ++i) few.push_back(i);     // background
  for (std::uint32_t i = 50; i < 60; ++i) few.push_back(i);   // object
  EXPECT_FALSE(search(set, few, Objective::kClass, 1));       // 19 samples: no two sides of 10
  for (std::uint32_t i = 60; i < 100; ++i) few.push_back(i);  // separating the labels would leave 9
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {  // few samples try few tests, of which most see nothing
    const auto test = search(set, few, Objective::kClass, seed);
    if (!test) continue;
    ++found;
    const auto right =
        std::count_if(few.begin(), few.end(), [&](std::uint32_t s) { return goes_right(set, *test, set.samples[s]); });
    EXPECT_GE(right, SplitSearch::kMinSide);
    EXPECT_LE(right, static_cast<std::ptrdiff_t>(few.size()) - SplitSearch::kMinSide);
  }
  EXPECT_GT(found, 5);
}

TEST(SplitSearch, WithoutTrustInTheLightNoSinglePixelOfIntensityDecides) {
  const TrainingSet set = toy::planted_set();
  TrainingSettings settings;
  settings.tests_per_node = 800;
  settings.single_pixel_fraction = 1.0;
  const PatchSettings patch;
  for (const std::uint64_t seed : {1, 2, 3}) {
    Random random(seed);
    const auto wary =
        SplitSearch(set, patch, settings, {1.0F, 1.0F}, false).best_test(every_sample(set), Objective::kClass, random);
    ASSERT_TRUE(wary);
    EXPECT_EQ(wary->plane, toy::kClassPlane);
    EXPECT_EQ(wary->kind, PixelTest::kDifference);
    const auto trusting =
        SplitSearch(set, patch, settings, {1.0F, 1.0F}, true).best_test(every_sample(set), Objective::kClass, random);
    ASSERT_TRUE(trusting);
    EXPECT_EQ(trusting->kind, PixelTest::kSinglePixel);
  }
}

void swap_planes(std::vector<FeatureImage>& images, int one, int other) {
  for (FeatureImage& image : images) {
    for (int y = 0; y < 32; ++y) {
      for (int x = 0; x < 32; ++x) std::swap(image.at(x, y)[one], image.at(x, y)[other]);
    }
    image.replicate_border();
  }
}

/// Returns in how many of ten searches the best test reads one pixel, where `plane` alone separates the labels.
int alone_of_ten(const FeatureLayout& layout, int plane, double shape_single_pixel_fraction) {
  toy::Planted planted = toy::plant();
  planted.set.layout = layout;
  swap_planes(planted.images, toy::kClassPlane, plane);
  const TrainingSet set = toy::set_of(planted);
  TrainingSettings settings;
  settings.tests_per_node = 800;
  settings.single_pixel_fraction = 0.0;
  settings.shape_single_pixel_fraction = shape_single_pixel_fraction;
  const PatchSettings patch;
  SplitSearch search(set, patch, settings, {1.0F, 1.0F}, true);
  Random random(4);
  int alone = 0;
  for (int i = 0; i < 10; ++i) {
    const auto test = search.best_test(every_sample(set), Objective::kClass, random);
    EXPECT_TRUE(test && test->plane == plane);
    alone += test && test->kind == PixelTest::kSinglePixel ? 1 : 0;
  }
  return alone;
}

TEST(SplitSearch, TestsOnShapeLookAtOnePixelAsOftenAsAskedAndThoseOnLightDoNot) {
  FeatureSettings features;
  features.handling = ScaleHandling::kScaleSpace;  // with planes of scaled depth
  const FeatureLayout layout(features);
  for (const double fraction : {0.0, 1.0}) EXPECT_EQ(alone_of_ten(layout, toy::kClassPlane, fraction), 0);
  const int surface = layout.block(kDepthHog).first;
  EXPECT_EQ(alone_of_ten(layout, surface, 0.0), 0);
  EXPECT_EQ(alone_of_ten(layout, surface, 1.0), 10);
  const int scaled_depth = layout.block(kDepthValue).first;  // half of the tests at least
  EXPECT_GT(alone_of_ten(layout, scaled_depth, 0.0), 0);
  EXPECT_LT(alone_of_ten(layout, scaled_depth, 0.0), 10);
  EXPECT_EQ(alone_of_ten(layout, scaled_depth, 1.0), 10);
}

TEST(SplitSearch, ANodeLooksAtPointHistogramsOrAtTheRestAsOftenAsAsked) {
  FeatureSettings features;
  features.families = kIntensity | kFastHistogram;
  toy::Planted planted = toy::plant();
  planted.set.layout = FeatureLayout(features);
  const int first = planted.set.layout.block(kFastHistogram).first;
  for (FeatureImage& image : planted.images) {
    FeatureImage wide(32, 32, planted.set.layout.pixel_stride());
    for (int y = 0; y < 32; ++y) {
      for (int x = 0; x < 32; ++x) {
        wide.at(x, y)[toy::kClassPlane] = image.at(x, y)[toy::kClassPlane];
        wide.at(x, y)[first] = image.at(x, y)[toy::kClassPlane];
      }
    }
    wide.replicate_border();
    image = wide;
  }
  const TrainingSet set = toy::set_of(planted);
  TrainingSettings settings;
  const PatchSettings patch;
  for (const auto& [fraction, minimum, maximum] : {std::tuple{0.0, 0, 0}, {0.3, 5, 27}, {1.0, 50, 50}}) {
    settings.histogram_fraction = fraction;
    SplitSearch search(set, patch, settings, {1.0F, 1.0F}, true);
    Random random(6);
    int histograms = 0;
    for (int i = 0; i < 50; ++i) {
      const auto test = search.best_test(every_sample(set), Objective::kClass, random);
      ASSERT_TRUE(test);
      histograms += test->plane == first ? 1 : 0;
    }
    EXPECT_GE(histograms, minimum) << fraction;
    EXPECT_LE(histograms, maximum) << fraction;
  }
}

/// Returns the number of samples that the test sends to the wrong side, by test_value.
int misplaced(const TrainingSet& set, const PixelTest& test) {
  int object_right = 0;
  int background_right = 0;
  for (const TrainingSample& sample : set.samples) {
    (sample.label != 0 ? object_right : background_right) += goes_right(set, test, sample) ? 1 : 0;
  }
  const int half = static_cast<int>(set.samples.size()) / 2;
  return std::min(half - object_right + background_right, half - background_right + object_right);
}

std::optional<PixelTest> search_for_class(const TrainingSet& set, double single_pixel_fraction) {
  TrainingSettings settings;
  settings.tests_per_node = 800;
  settings.single_pixel_fraction = single_pixel_fraction;
  const PatchSettings patch;
  Random random(4);
  return SplitSearch(set, patch, settings, {1.0F, 1.0F}, true).best_test(every_sample(set), Objective::kClass, random);
}

TEST(SplitSearch, ADifferenceSeparatesAsTestValueDoesAtEveryPatchScale) {
  TrainingSet set = toy::planted_set();
  Random random(8);
  for (TrainingSample& sample : set.samples) sample.scale = random.between(200, 400);
  const auto test = search_for_class(set, 0.0);
  ASSERT_TRUE(test);
  EXPECT_EQ(test->plane, toy::kClassPlane);
  EXPECT_EQ(test->kind, PixelTest::kDifference);
  EXPECT_EQ(misplaced(set, *test), 0);
}

TEST(SplitSearch, OnePixelAloneSeparatesByASingleStepOfGrey) {
  toy::Planted planted = toy::plant();
  for (std::size_t i = 0; i < planted.images.size(); ++i) {
    FeatureImage& image = planted.images[i];
    for (int p = 0; p < 32 * 32; ++p) image.at(p % 32, p / 32)[toy::kClassPlane] = i % 2 == 1 ? 101 : 100;
    image.replicate_border();
  }
  const TrainingSet set = toy::set_of(planted);
  const auto test = search_for_class(set, 1.0);
  ASSERT_TRUE(test);
  EXPECT_EQ(test->plane, toy::kClassPlane);
  EXPECT_EQ(test->kind, PixelTest::kSinglePixel);
  EXPECT_EQ(test->threshold, 101);
  EXPECT_EQ(misplaced(set, *test), 0);
}

TEST(SplitSearch, DepthIsComparedModulo256) {
  toy::Planted planted = toy::plant();
  FeatureSettings features;
  features.families = kDepthValue;
  planted.set.layout = FeatureLayout(features);
  for (std::size_t i = 0; i < planted.images.size(); ++i) {
    FeatureImage image(32, 32, planted.set.layout.pixel_stride());
    for (int y = 0; y < 32; ++y) {
      for (int x = 0; x < 32; ++x) {  // the object's ramp runs over 256 in the middle of the samples
        const int value = i % 2 == 1 ? 256 - 48 + 3 * x : 60;
        for (const int plane : {0, 1}) image.at(x, y)[plane] = static_cast<std::uint8_t>(value & 255);
      }
    }
    image.replicate_border();
    planted.images[i] = image;
  }
  const TrainingSet set = toy::set_of(planted);
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto test = search(set, every_sample(set), Objective::kClass, seed);
    ASSERT_TRUE(test);
    EXPECT_EQ(test->kind, PixelTest::kWrapping);
    EXPECT_EQ(misplaced(set, *test), 0);
  }
}

TEST(SplitSearch, TestsStayInsideThePatchAndWrapDepthOnly) {
  TrainingSet set = toy::planted_set();
  for (const std::uint64_t seed : {5, 6, 7, 8}) {
    const auto test = search(set, every_sample(set), Objective::kOffset, seed);
    ASSERT_TRUE(test);
    for (const std::int8_t step : {test->dx1, test->dy1, test->dx2, test->dy2}) EXPECT_LE(std::abs(step), 10);
    EXPECT_NE(test->kind, PixelTest::kWrapping);
  }
}

}  // namespace
}  // namespace houghstream::training
