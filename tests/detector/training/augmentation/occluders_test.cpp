#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "detector/training/augmentation/composites.hpp"
#include "tests/detector/toy_data.hpp"

namespace houghstream::training {
namespace {

constexpr double kDistance = 0.9;

Composite bare_tile(std::uint64_t seed) {
  AugmentationSettings settings;
  settings.lighting_variation = 0.0;
  settings.occluded_fraction = 0.0;
  Random random(seed);
  return make_composite(toy::training_views().front(), toy::background(5), kDistance, settings, random).value();
}

struct Pair {
  Composite before;
  Composite after;
};

/// Returns the pairs of those seeds whose occluder found a place.
std::vector<Pair> occluded_tiles() {
  std::vector<Pair> pairs;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Pair pair{bare_tile(seed), bare_tile(seed)};
    Random random(seed + 100);
    add_occluder(toy::background(6), kDistance, pair.after, random);
    if (!pair.after.occluder.empty()) pairs.push_back(std::move(pair));
  }
  return pairs;
}

TEST(Occluders, HideAPartAndAreNearer) {
  const std::vector<Pair> pairs = occluded_tiles();
  EXPECT_GT(pairs.size(), 15U);
  for (const auto& [before, after] : pairs) {
    const int whole = cv::countNonZero(before.mask);
    const int seen = cv::countNonZero(after.mask);
    EXPECT_EQ(whole, before.whole_px);
    EXPECT_LE(seen, 0.9 * whole);
    EXPECT_GE(seen, 0.2 * whole);
    EXPECT_EQ(cv::countNonZero(after.mask & after.occluder), 0);
    double farthest = 0.0;
    cv::minMaxLoc(after.frame.depth, nullptr, &farthest, nullptr, nullptr, after.occluder);
    EXPECT_LT(farthest, kDistance + 0.02);
  }
}

TEST(Occluders, WhatTheyDoNotHideStaysButForTheInfraredShadowToTheirLeft) {
  for (const auto& [before, after] : occluded_tiles()) {
    for (int y = 0; y < after.mask.rows; ++y) {
      for (int x = 0; x < after.mask.cols; ++x) {
        if (after.occluder.at<std::uint8_t>(y, x) != 0) continue;
        ASSERT_EQ(after.frame.colour.at<cv::Vec3b>(y, x), before.frame.colour.at<cv::Vec3b>(y, x));
        const float depth = after.frame.depth.at<float>(y, x);
        if (depth == before.frame.depth.at<float>(y, x)) continue;
        ASSERT_TRUE(std::isnan(depth));
        ASSERT_GT(cv::countNonZero(after.occluder.row(y).colRange(x, after.mask.cols)), 0)
            << "no occluder to its right";
      }
    }
  }
}

}  // namespace
}  // namespace houghstream::training
