#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <set>
#include <stdexcept>
#include <utility>

#include "detector/baseline/baseline_scales.hpp"
#include "detector/baseline/gall_profile.hpp"
#include "detector/baseline/scale_space_search.hpp"
#include "detector/training/augmentation/training_set.hpp"
#include "tests/detector/toy_data.hpp"

namespace houghstream::training {
namespace {

constexpr double kFocal = 262.5;
constexpr double kTaught = 0.7;  // metres
constexpr int kMargin = 48;      // frame pixels around the object in a composite
constexpr int kRadius = 22;      // radius of the mask, frame pixels

/// Returns a round part of a flat tile.
TrainingView round_view() {
  TrainingView view = toy::training_views().front();
  view.mask.setTo(0);
  cv::circle(view.mask, cv::Point(160, 120), kRadius, cv::Scalar(255), cv::FILLED);
  view.frame.depth.setTo(static_cast<float>(kTaught), view.mask);
  return view;
}

Profile open_profile(const std::string& name) {
  Profile profile = baseline::make_profile(name);
  profile.training.occluded_fraction = 0.0;
  profile.training.lighting_variation = 0.0;
  profile.training.patches_per_view = 120;
  profile.training.patches_per_background = 80;
  profile.training.composites_per_view = 1;
  return profile;
}

ImageInput input_of(const Profile& profile) {
  return {profile.features, profile.patch, profile.training, baseline::scales_of(profile.features)};
}

TrainingImage image_of(const TrainingView& view, const Profile& profile, std::uint64_t seed) {
  Random random(seed);
  ImageWorkspace workspace;
  return object_image({view, 2, 5}, toy::background(3), input_of(profile), random, workspace);
}

/// Returns the scale of the object in the image relative to the view, without `image_scale`.
double size_of(const TrainingImage& image, double image_scale) {
  return (image.size.width / image_scale - 2 * kMargin) / (2 * kRadius + 1);
}

TEST(TrainingImages, OffsetsOfAScaleSpaceLeadToTheCentresPixel) {
  const TrainingView view = round_view();
  for (const float image_scale : {1.0F, 0.5F}) {
    Profile profile = open_profile("gall");
    profile.features.image_scale = image_scale;
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
      const TrainingImage image = image_of(view, profile, seed);
      const double size = size_of(image, image_scale);
      // the mask's middle is the image's; the object's centre lies half a pixel of the view beside it
      const double x = 0.5 * (image.size.width - 1) - 0.5 * size * image_scale;
      const double y = 0.5 * (image.size.height - 1) - 0.5 * size * image_scale;
      for (const TrainingSample& sample : image.samples) {
        if (sample.label == 0) continue;
        ASSERT_NEAR(sample.x + sample.offset.x() * kFocal * image_scale, x, 0.6) << "size " << size;
        ASSERT_NEAR(sample.y + sample.offset.y() * kFocal * image_scale, y, 0.6) << "size " << size;
        ASSERT_EQ(sample.offset.z(), 0.0F);
        ASSERT_EQ(sample.scale, 256);
      }
    }
  }
}

TEST(TrainingImages, SamplesOfTheObjectLieOnItsMaskAndTheOthersBeside) {
  const TrainingView view = round_view();
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const TrainingImage image = image_of(view, open_profile("gall"), seed);
    const double radius = kRadius * size_of(image, 1.0);
    int on_object = 0;
    int beside = 0;
    for (const TrainingSample& sample : image.samples) {
      const double distance =
          std::hypot(sample.x - 0.5 * (image.size.width - 1), sample.y - 0.5 * (image.size.height - 1));
      if (sample.label == 0) {
        ASSERT_GT(distance, radius - 2.0);
        ++beside;
      } else {
        ASSERT_LT(distance, radius + 2.0);
        ASSERT_EQ(sample.label, 2);
        ASSERT_EQ(sample.view, 5U);
        ++on_object;
      }
    }
    EXPECT_EQ(on_object, 120);
    EXPECT_EQ(beside, 30);
    EXPECT_TRUE(image.negative_pool.empty());
  }
}

const std::uint8_t* pixel_of(const TrainingImage& image, cv::Point at) {
  for (const Cutout& cutout : image.cutouts) {
    if (contains(cutout.held(), {at.x, at.y, 1, 1})) return cutout.at(at.x, at.y);
  }
  throw std::runtime_error("no patch reads this pixel");
}

/// Returns the deviation of the slope at the object's centre, 0 to 127; the derivatives are the first planes.
double unevenness(const TrainingImage& image) {
  constexpr int kReach = 8;  // pixels
  const cv::Point middle(image.size.width / 2, image.size.height / 2);
  std::vector<double> slopes;
  for (int y = -kReach; y <= kReach; ++y) {
    for (int x = -kReach; x <= kReach; ++x) {
      slopes.push_back(pixel_of(image, middle + cv::Point(x, y))[0]);
    }
  }
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(slopes, mean, deviation);
  return deviation[0];
}

TEST(TrainingImages, AScaleSpaceIsTaughtTheNoiseOfTheDistancesItSearches) {
  Profile five = open_profile("gall");
  five.features.families = kDepthDerivatives;
  Profile single = five;
  baseline::set_scale_handling(single, "single");
  double smooth = 0.0;
  double rough = 0.0;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    smooth += unevenness(image_of(round_view(), single, seed));
    rough += unevenness(image_of(round_view(), five, seed));
  }
  EXPECT_GT(rough, 2.0 * smooth);
}

/// Checks that an image holds all pixels that its patches read, and few more.
void expect_held(const TrainingImage& image, const PatchSettings& patch) {
  std::set<std::pair<int, int>> read;
  for (const auto* list : {&image.samples, &image.negative_pool}) {
    for (const TrainingSample& sample : *list) {
      const int reach = max_offset(patch, sample.scale);
      const cv::Rect seen(sample.x - reach, sample.y - reach, 2 * reach + 1, 2 * reach + 1);
      ASSERT_TRUE(contains(image.cutouts.at(static_cast<std::size_t>(sample.cutout)).held(), seen)) << sample.x;
      for (int y = seen.y; y < seen.br().y; ++y)
        for (int x = seen.x; x < seen.br().x; ++x) read.emplace(x, y);
    }
  }
  std::size_t held = 0;
  for (const Cutout& cutout : image.cutouts) held += cutout.held().pixels();
  EXPECT_GE(held, read.size());
  EXPECT_LE(static_cast<double>(held), 1.1 * static_cast<double>(read.size()));
}

TEST(TrainingImages, ImagesHoldWhatTheirPatchesReadOnly) {
  const Profile profile = open_profile("realtime");
  ImageWorkspace workspace;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    expect_held(image_of(round_view(), profile, seed), profile.patch);
    Random random(seed);
    for (const FeatureLevel& level : feature_levels(profile.features)) {
      expect_held(background_image(toy::background(3), level, input_of(profile), random, workspace), profile.patch);
    }
  }
}

TEST(TrainingImages, NoPixelIsDrawnTwice) {
  const TrainingImage image = image_of(round_view(), open_profile("gall"), 4);
  std::vector<std::pair<int, int>> places;
  for (const TrainingSample& sample : image.samples) places.emplace_back(sample.x, sample.y);
  std::sort(places.begin(), places.end());
  EXPECT_EQ(std::adjacent_find(places.begin(), places.end()), places.end());
}

TEST(TrainingImages, AScaleSpaceIsTaughtTheSizesBetweenThoseThatAreSearched) {
  const TrainingView view = round_view();
  std::vector<double> sizes;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const TrainingImage image = image_of(view, open_profile("gall"), seed);
    sizes.push_back(size_of(image, 1.0));
    const double area = M_PI * kRadius * kRadius * sizes.back() * sizes.back() / kFocal / kFocal;  // as at 1 m
    EXPECT_NEAR(image.whole_area, area, 0.06 * area);
  }
  const auto [smallest, largest] = std::minmax_element(sizes.begin(), sizes.end());
  EXPECT_NEAR(*smallest, 1.0 / 1.25, 0.05);
  EXPECT_NEAR(*largest, 1.25, 0.05);
}

TEST(TrainingImages, WithDepthTheAreaIsThatOfTheSurfaceAtAnyDistance) {
  const TrainingView view = round_view();
  const double area = M_PI * kRadius * kRadius * kTaught * kTaught / kFocal / kFocal;
  Profile profile = open_profile("realtime");
  const double working = feature_levels(profile.features, view.frame.camera)[0].scale * kFocal;
  for (const float distance : {0.5F, 0.7F, 1.1F}) {
    profile.training.min_distance = distance;
    profile.training.max_distance = distance;
    const TrainingImage image = image_of(view, profile, 1);
    EXPECT_NEAR(image.whole_area, area, 0.08 * area) << distance;
    for (const TrainingSample& sample : image.samples) {
      if (sample.label == 0) continue;
      ASSERT_NEAR(sample.scale, patch_scale(profile.patch, working, distance), 6) << distance;  // it faces the camera
    }
  }
}

TEST(TrainingImages, OnlyWithoutScaleSpaceMustDepthBeKnown) {
  TrainingView view = round_view();
  view.frame.depth.setTo(std::numeric_limits<float>::quiet_NaN());
  const auto objects = [&](const std::string& name) {
    const TrainingImage image = image_of(view, open_profile(name), 1);
    return std::count_if(image.samples.begin(), image.samples.end(),
                         [](const TrainingSample& sample) { return sample.label != 0; });
  };
  EXPECT_EQ(objects("gall"), 120);
  EXPECT_EQ(objects("realtime"), 0);
}

TEST(TrainingImages, ATooSmallBackgroundGivesNothing) {
  RgbdFrame corner = toy::background(3);
  corner.colour = corner.colour(cv::Rect(0, 0, 120, 120)).clone();
  corner.depth = corner.depth(cv::Rect(0, 0, 120, 120)).clone();
  corner.camera = corner.camera.cropped(0, 0, 120, 120);
  Random random(1);
  ImageWorkspace workspace;
  const TrainingView view = round_view();
  const Profile gall = open_profile("gall");
  const TrainingImage image = object_image({view, 1, 0}, corner, input_of(gall), random, workspace);
  EXPECT_TRUE(image.samples.empty());
  EXPECT_EQ(image.whole_area, 0.0F);
}

TEST(TrainingImages, ABackgroundIsDrawnFromWhereItsLevelSees) {
  RgbdFrame room = toy::background(3);
  room.depth.setTo(0.8F);
  room.depth.colRange(0, 160).setTo(2.0F);
  Profile profile = open_profile("realtime");
  const std::vector<FeatureLevel> levels = feature_levels(profile.features);
  ASSERT_EQ(levels.size(), 2U);
  for (const FeatureLevel& level : levels) {
    const float seen = level.min_distance > 0.0F ? 2.0F : 0.8F;
    Random random(7);
    ImageWorkspace workspace;
    const TrainingImage image = background_image(room, level, input_of(profile), random, workspace);
    const auto drawn = static_cast<std::size_t>(profile.training.patches_per_background / kBackgroundImages);
    EXPECT_EQ(image.samples.size(), drawn);
    EXPECT_EQ(image.negative_pool.size(), drawn * static_cast<std::size_t>(profile.training.negative_pool));
    for (const auto* list : {&image.samples, &image.negative_pool}) {
      for (const TrainingSample& sample : *list) {
        ASSERT_EQ(sample.label, 0);
        ASSERT_EQ(sample.scale, patch_scale(profile.patch, kFocal * level.scale, seen));
      }
    }
  }
}

TEST(TrainingImages, ABackgroundOfAScaleSpaceNeedsNoDepth) {
  RgbdFrame room = toy::background(3);
  room.depth.setTo(std::numeric_limits<float>::quiet_NaN());
  const Profile profile = open_profile("gall");
  for (const FeatureLevel& level : baseline::scale_space_levels(profile.features)) {
    Random random(7);
    ImageWorkspace workspace;
    const TrainingImage image = background_image(room, level, input_of(profile), random, workspace);
    EXPECT_EQ(image.samples.size(), 20U) << level.size_ratio;
    EXPECT_TRUE(image.negative_pool.empty());
    for (const TrainingSample& sample : image.samples) ASSERT_EQ(sample.scale, 256);
  }
}

}  // namespace
}  // namespace houghstream::training
