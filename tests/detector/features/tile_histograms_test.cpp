#include "detector/features/tile_histograms.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "detector/baseline/reference_features.hpp"
#include "pipeline/base/random.hpp"
#include "tests/every_target.hpp"

namespace houghstream {
namespace {

constexpr int kBins = HistogramSteps::kBins;

/// Returns the steps in each bin of one gradient that stands alone.
std::vector<int> shares_of(float dx, float dy) {
  cv::Mat across = cv::Mat::zeros(3, 21, CV_32FC1);
  cv::Mat down = across.clone();
  across.at<float>(1, 17) = dx;
  down.at<float>(1, 17) = dy;
  TilePlane<float> tile_dx;
  TilePlane<float> tile_dy;
  BinPlanes bins;
  for (auto* plane : {&tile_dx, &tile_dy}) plane->reset(across.size(), 2);
  tile_dx.load(across, {});
  tile_dy.load(down, {});
  for (auto& bin : bins) bin.reset(across.size(), 2);
  bin_gradients(tile_dx, tile_dy, 1.0F, bins);
  std::vector<int> steps;
  for (const auto& bin : bins) {
    steps.push_back(bin.row(1)[17]);
    EXPECT_EQ(bin.row(1)[16], 0);
    EXPECT_EQ(bin.row(0)[17], 0);
  }
  return steps;
}

TEST(TileHistograms, AGradientIsSharedByTheTwoBinsBesideIt) {
  simd::with_every_target([] {
    EXPECT_EQ(shares_of(2.0F, 0.0F), (std::vector<int>{32, 0, 0, 0, 0, 0, 0, 0, 0}));
    EXPECT_EQ(shares_of(-2.0F, 0.0F), (std::vector<int>{32, 0, 0, 0, 0, 0, 0, 0, 0}));  // orientation has no sign
    EXPECT_EQ(shares_of(0.0F, 2.0F), (std::vector<int>{0, 0, 0, 0, 16, 16, 0, 0, 0}));  // 90 degrees: bin 4.5
    EXPECT_EQ(shares_of(3.0F, 3.0F), shares_of(-3.0F, -3.0F));
    const std::vector<int> diagonal = shares_of(3.0F, 3.0F);  // bin 2.25 of 67.9 steps
    EXPECT_NEAR(diagonal[2], 50.9, 1.2);
    EXPECT_NEAR(diagonal[3], 17.0, 1.2);
    const std::vector<int> last = shares_of(-9.8481F, 1.7365F);  // 170 degrees: bin 8.5, beside it the first
    EXPECT_NEAR(last[8], 80, 2);
    EXPECT_NEAR(last[0], 80, 2);
    EXPECT_EQ(last[1] + last[7], 0);
  });
}

TilePlane<std::uint8_t> smoothed(const cv::Mat& steps) {
  TilePlane<std::uint16_t> bin;
  bin.reset(steps.size(), 5);
  bin.load(steps, {});
  TilePlane<std::uint8_t> bytes;
  bytes.reset(steps.size(), 3);
  smooth_bin(bin, bytes);
  return bytes;
}

TEST(TileHistograms, TheWindowReachesTwoPixelsAndKeepsTheMean) {
  cv::Mat even(6, 40, CV_16UC1, cv::Scalar(1600));
  cv::Mat full(6, 40, CV_16UC1, cv::Scalar(8000));
  cv::Mat alone = cv::Mat::zeros(6, 40, CV_16UC1);
  alone.at<std::uint16_t>(3, 20) = 16000;
  simd::with_every_target([&] {
    const TilePlane<std::uint8_t> mean = smoothed(even);
    EXPECT_EQ(mean.row(3)[20], 100);
    EXPECT_EQ(mean.row(-3)[-3], 100);
    EXPECT_EQ(mean.row(8)[42], 100);
    EXPECT_EQ(smoothed(full).row(3)[20], 255);
    const TilePlane<std::uint8_t> peak = smoothed(alone);
    EXPECT_EQ(peak.row(3)[20], 118);  // 1000 x 0.3434^2
    EXPECT_EQ(peak.row(3)[21], 83);   // 1000 x 0.3434 x 0.2427
    EXPECT_EQ(peak.row(2)[20], 83);
    EXPECT_EQ(peak.row(4)[18], 21);  // 1000 x 0.2427 x 0.0856
    EXPECT_EQ(peak.row(1)[18], 7);
    EXPECT_EQ(peak.row(3)[17], 0);
    EXPECT_EQ(peak.row(0)[20], 0);
  });
}

TEST(TileHistograms, AreThoseOfTheReadableFeatures) {
  Random random(3);
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(45, 7), cv::Size(kMaxPart, 4)}) {
    cv::Mat_<float> dx(size);
    cv::Mat_<float> dy(size);
    for (cv::Mat_<float>* plane : {&dx, &dy}) {
      for (float& value : *plane) {
        value =
            random.uniform() < 0.2 ? 0.0F : static_cast<float>(random.uniform(-1.0, 1.0) * random.uniform(0.0, 120.0));
      }
    }
    const std::vector<cv::Mat> expected = baseline::gradient_histograms(dx, dy, 8.0F);
    simd::with_every_target([&] {
      TilePlane<float> tile_dx;
      TilePlane<float> tile_dy;
      BinPlanes bins;
      for (auto* plane : {&tile_dx, &tile_dy}) plane->reset(size, 3);
      tile_dx.load(dx, {});
      tile_dy.load(dy, {});
      for (auto& bin : bins) bin.reset(size, 3);
      bin_gradients(tile_dx, tile_dy, 8.0F, bins);
      TilePlane<std::uint8_t> bytes;
      bytes.reset(size, 1);
      int wrong = 0;
      for (std::size_t b = 0; b < kBins; ++b) {
        smooth_bin(bins[b], bytes);
        for (int y = 0; y < size.height; ++y) {
          for (int x = 0; x < size.width; ++x) wrong += bytes.row(y)[x] == expected[b].at<std::uint8_t>(y, x) ? 0 : 1;
        }
      }
      EXPECT_EQ(wrong, 0) << size;
    });
  }
}

}  // namespace
}  // namespace houghstream
