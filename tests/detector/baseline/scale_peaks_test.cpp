#include "detector/baseline/scale_peaks.hpp"

#include <gtest/gtest.h>

namespace houghstream {
namespace {

ScalePeak peak(int size, float x_px, float mass, std::int32_t class_id = 1) {
  ScalePeak out;
  out.candidate.detection.class_id = class_id;
  out.candidate.evidence.mass_share = mass;
  out.at_px = {x_px, 50.0F};
  out.reach_px = 8.0F;
  out.size = size;
  return out;
}

std::vector<float> kept_masses(const std::vector<ScalePeak>& peaks) {
  std::vector<float> masses;
  for (const Candidate& candidate : maxima_over_sizes(peaks)) masses.push_back(candidate.evidence.mass_share);
  return masses;
}

using Masses = std::vector<float>;

TEST(ScalePeaks, OfTwoInNeighbouringSizesTheHigherIsTheMaximum) {
  EXPECT_EQ(kept_masses({peak(1, 100, 0.4F), peak(2, 104, 0.6F)}), Masses({0.6F}));
  EXPECT_EQ(kept_masses({peak(1, 100, 0.6F), peak(2, 104, 0.4F)}), Masses({0.6F}));
}

TEST(ScalePeaks, OfEqualNeighboursTheFirstCounts) {
  EXPECT_EQ(kept_masses({peak(1, 100, 0.5F), peak(2, 104, 0.5F)}), Masses({0.5F}));
}

TEST(ScalePeaks, WhatIsNoNeighbourStays) {
  const ScalePeak low = peak(1, 100, 0.4F);
  EXPECT_EQ(kept_masses({low, peak(2, 109, 0.6F)}), Masses({0.4F, 0.6F}));     // out of reach
  EXPECT_EQ(kept_masses({low, peak(3, 100, 0.6F)}), Masses({0.4F, 0.6F}));     // two sizes away
  EXPECT_EQ(kept_masses({low, peak(1, 100, 0.6F)}), Masses({0.4F, 0.6F}));     // the same size decides by itself
  EXPECT_EQ(kept_masses({low, peak(2, 100, 0.6F, 2)}), Masses({0.4F, 0.6F}));  // another object
}

TEST(ScalePeaks, TheLargerReachCounts) {
  ScalePeak coarse = peak(0, 100, 0.6F);
  coarse.reach_px = 20.0F;
  EXPECT_EQ(kept_masses({coarse, peak(1, 115, 0.4F)}), Masses({0.6F}));
}

TEST(ScalePeaks, ASlopeHidesWhatIsLowerThanItself) {
  EXPECT_EQ(kept_masses({peak(0, 100, 0.3F), peak(1, 106, 0.4F), peak(2, 112, 0.6F)}), Masses({0.6F}));
}

TEST(ScalePeaks, NothingGivesNothing) {
  EXPECT_TRUE(maxima_over_sizes({}).empty());
}

}  // namespace
}  // namespace houghstream
