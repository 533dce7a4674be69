#include "detector/training/augmentation/patch_cover.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <iterator>

#include "detector/training/augmentation/training_set.hpp"
#include "detector/training/tree_trainer.hpp"
#include "pipeline/base/random.hpp"
#include "tests/detector/planted_set.hpp"

namespace houghstream::training {
namespace {

FeatureImage noise_image(int pixel_stride, Random& random) {
  FeatureImage image(70, 50, pixel_stride);
  for (int y = 0; y < 50; ++y) {
    for (int x = 0; x < 70; ++x) {
      for (int p = 0; p < pixel_stride; ++p) image.at(x, y)[p] = static_cast<std::uint8_t>(random.below(256));
    }
  }
  image.replicate_border();
  return image;
}

TrainingSample random_sample(Random& random) {
  TrainingSample sample;
  sample.x = static_cast<std::int16_t>(random.between(0, 69));
  sample.y = static_cast<std::int16_t>(random.between(0, 49));
  sample.scale = random.between(60, 600);
  return sample;
}

std::vector<TrainingSample*> pointers(std::vector<TrainingSample>& samples) {
  std::vector<TrainingSample*> out;
  out.reserve(samples.size());
  for (TrainingSample& sample : samples) out.push_back(&sample);
  return out;
}

PixelTest random_test(Random& random) {
  const auto step = [&] { return static_cast<std::int8_t>(random.between(-10, 10)); };
  PixelTest test;
  test.dx1 = step();
  test.dy1 = step();
  test.dx2 = step();
  test.dy2 = step();
  test.plane = static_cast<std::uint8_t>(random.below(60));
  test.kind = std::array{PixelTest::kDifference, PixelTest::kWrapping, PixelTest::kSinglePixel}.at(
      static_cast<std::size_t>(random.below(3)));
  return test;
}

/// Checks that tests read in the cutouts what they read in the image.
void expect_same_values(const FeatureImage& whole, const std::vector<Cutout>& cutouts,
                        const std::vector<TrainingSample>& samples, Random& random) {
  for (const TrainingSample& sample : samples) {
    const CutoutPatch patch =
        cutouts.at(static_cast<std::size_t>(sample.cutout)).patch(sample.x, sample.y, sample.scale);
    for (int i = 0; i < 40; ++i) {
      const PixelTest test = random_test(random);
      ASSERT_EQ(test_value(test, patch), test_value(test, whole.patch(sample.x, sample.y, sample.scale)))
          << sample.x << " " << sample.y << " " << sample.scale;
    }
  }
}

TEST(PatchCover, TestsReadInACutoutWhatTheyReadInTheImage) {
  Random random(2);
  for (const int count : {1, 3, 40}) {
    const FeatureImage image = noise_image(64, random);
    std::vector<TrainingSample> samples;
    for (int i = 0; i < count; ++i) samples.push_back(random_sample(random));
    const std::vector<Cutout> cutouts = cut_out_patches(image, {}, 0, pointers(samples));
    expect_same_values(image, cutouts, samples, random);
  }
}

TEST(PatchCover, WhatIsStillReadStaysAsItIs) {
  Random random(3);
  const FeatureImage image = noise_image(64, random);
  TrainingSet set;
  set.cutouts.emplace_back(image, spans_of(image.held()));
  for (int i = 0; i < 12; ++i) set.samples.push_back(random_sample(random));
  const std::size_t before = set.held_bytes();
  drop_unread_pixels({}, set);
  EXPECT_LT(set.held_bytes(), before);
  expect_same_values(image, set.cutouts, set.samples, random);
  set.samples.clear();
  drop_unread_pixels({}, set);
  EXPECT_EQ(set.held_bytes(), 0U);
}

TEST(PatchCover, PartsAreMergedWhereThatSavesPixels) {
  const std::vector<RowSpans> apart = cover_patches({{0, 0, 5, 5}, {5, 0, 5, 5}, {30, 2, 5, 5}});
  EXPECT_EQ(apart.size(), 3U);
  const std::vector<RowSpans> stairs = cover_patches({{0, 0, 5, 5}, {30, 2, 5, 5}, {2, 3, 5, 5}});
  ASSERT_EQ(stairs.size(), 2U);
  EXPECT_EQ(stairs[1].top, 0);
  EXPECT_EQ(stairs[1].columns,
            (std::vector<cv::Range>{{0, 5}, {0, 5}, {0, 5}, {0, 7}, {0, 7}, {2, 7}, {2, 7}, {2, 7}}));
}

TEST(PatchCover, ATreeGrownOnCutoutsIsThatGrownOnWholeImages) {
  const toy::Planted planted = toy::plant();
  TrainingSet cut = planted.set;
  for (std::size_t i = 0; i < planted.images.size(); ++i) {
    std::vector<TrainingSample*> readers;
    for (TrainingSample& sample : cut.samples) {
      if (sample.image == static_cast<std::int32_t>(i)) readers.push_back(&sample);
    }
    const auto first = static_cast<std::int32_t>(cut.cutouts.size());
    std::vector<Cutout> own = cut_out_patches(planted.images[i], {}, first, readers);
    std::move(own.begin(), own.end(), std::back_inserter(cut.cutouts));
  }
  TrainingSettings settings;
  settings.tests_per_node = 300;
  const Forest whole = grow_tree(toy::set_of(planted), {}, settings, 0);
  const Forest tree = grow_tree(cut, {}, settings, 0);
  ASSERT_GT(whole.nodes.size(), 1U);
  ASSERT_EQ(tree.nodes.size(), whole.nodes.size());
  EXPECT_EQ(std::memcmp(tree.nodes.data(), whole.nodes.data(), whole.nodes.size() * sizeof(TreeNode)), 0);
  EXPECT_EQ(tree.leaves, whole.leaves);
  EXPECT_EQ(tree.leaf_weights, whole.leaf_weights);
}

}  // namespace
}  // namespace houghstream::training
