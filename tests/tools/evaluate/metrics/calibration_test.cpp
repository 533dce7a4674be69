#include "tools/evaluate/metrics/calibration.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace houghstream {
namespace {

TEST(Calibration, TheErrorIsTheBinsDifferencesWeightedByTheirCounts) {
  // The bin 0.8 to 0.9 has mean 0.85 and 1 of 2 true: off by 0.35. The bin 0.1 to 0.2 has 0.15 and none of 1 true. 1.0
  // counts to the last bin.
  const Calibration found = calibrate({{0.82, true}, {0.88, false}, {0.15, false}, {1.0, true}}, 2);
  EXPECT_EQ(found.count, 4);
  EXPECT_NEAR(found.ece, (2 * 0.35 + 0.15 + 0.0) / 4, 1e-12);
  ASSERT_EQ(found.bins.size(), 10U);
  EXPECT_EQ(found.bins[8].count, 2);
  EXPECT_EQ(found.bins[8].from, 0.8);
  EXPECT_EQ(found.bins[8].to, 0.9);
  EXPECT_NEAR(found.bins[8].mean_score, 0.85, 1e-12);
  EXPECT_EQ(found.bins[8].true_fraction, 0.5);
  EXPECT_EQ(found.bins[9].count, 1);
  EXPECT_TRUE(std::isnan(found.bins[0].mean_score));
}

TEST(Calibration, WhatHoldsHasNoError) {
  std::vector<Prediction> statements;
  statements.reserve(100);
  for (int i = 0; i < 100; ++i) statements.push_back({0.75, i < 75});
  EXPECT_NEAR(calibrate(statements, 75).ece, 0.0, 1e-12);
}

TEST(Calibration, NothingWasStated) {
  const Calibration found = calibrate({}, 3);
  EXPECT_TRUE(std::isnan(found.ece));
  EXPECT_EQ(found.proposed.size(), 4U);
  EXPECT_FALSE(found.proposed[0].score.has_value());
}

TEST(Calibration, AThresholdIsTheSmallestScoreFromWhichThePrecisionHolds) {
  // At the top 1 of 2 predictions is true, and from 0.3 on 18 of 20.
  std::vector<Prediction> statements = {{0.99, true}, {0.98, false}};
  for (int i = 0; i < 17; ++i) statements.push_back({0.5 + 0.01 * i, true});
  statements.push_back({0.3, false});
  statements.push_back({0.2, false});
  const Calibration found = calibrate(statements, 36);
  EXPECT_EQ(found.proposed[0].precision, 0.90);
  EXPECT_EQ(found.proposed[0].score, 0.3);
  EXPECT_EQ(found.proposed[0].recall, 0.5);
  EXPECT_EQ(found.proposed[1].precision, 0.95);
  EXPECT_EQ(found.proposed[1].score, 0.99) << "the strongest alone";
  EXPECT_NEAR(found.proposed[1].recall, 1.0 / 36, 1e-12);
}

TEST(Calibration, EqualScoresCannotBeToldApart) {
  const Calibration found = calibrate({{0.9, true}, {0.5, true}, {0.5, false}}, 2);
  EXPECT_EQ(found.proposed[0].score, 0.9);
  EXPECT_FALSE(calibrate({{0.5, true}, {0.5, false}}, 1).proposed[0].score.has_value());
}

}  // namespace
}  // namespace houghstream
