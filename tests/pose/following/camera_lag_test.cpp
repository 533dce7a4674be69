#include "pose/following/camera_lag.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace houghstream {
namespace {

constexpr double kPrior_s = 0.01;

/// Returns the evidence of a registration that measures a lag, in deviations, with a standard deviation.
LagEvidence measured(double lag, double sigma) {
  return {1.0 / (sigma * sigma), lag / (sigma * sigma)};
}

TEST(CameraLag, NothingIsKnownBeforeSomethingMoves) {
  CameraLag lag(kPrior_s);
  lag.update({}, kPrior_s);
  EXPECT_EQ(lag.seconds(), 0.0);
  EXPECT_EQ(lag.sigma_s(), kPrior_s);
  EXPECT_FALSE(lag.is_known());
}

TEST(CameraLag, ManyRegistrationsAgreeOnTheLag) {
  CameraLag lag(kPrior_s);
  for (int i = 0; i < 2000; ++i) lag.update(measured(i % 2 == 0 ? -1.0 : -1.2, 0.3), kPrior_s);
  EXPECT_TRUE(lag.is_known());
  EXPECT_NEAR(lag.seconds(), -0.011, 0.0002);
}

TEST(CameraLag, EvidenceOfLongerDeviationsIsOfTheSameLag) {
  CameraLag lag(kPrior_s);
  for (int i = 0; i < 2000; ++i) lag.update(measured(-0.55, 0.15), 2.0 * kPrior_s);
  EXPECT_NEAR(lag.seconds(), -0.011, 0.0002);
}

TEST(CameraLag, OldEvidenceIsForgotten) {
  CameraLag lag(kPrior_s);
  for (int i = 0; i < 20'000; ++i) lag.update(measured(-1.0, 0.1), kPrior_s);
  for (int i = 0; i < 20'000; ++i) lag.update(measured(0.5, 0.1), kPrior_s);
  EXPECT_NEAR(lag.seconds(), 0.005, 0.0005);
  EXPECT_GE(lag.sigma_s(), 0.00049);
}

TEST(CameraLag, WhatIsNoNumberSaysNothing) {
  CameraLag lag(kPrior_s);
  lag.update({std::numeric_limits<double>::quiet_NaN(), 1.0}, kPrior_s);
  lag.update({1.0, std::numeric_limits<double>::quiet_NaN()}, kPrior_s);
  lag.update({1.0, 1.0}, 0.0);
  EXPECT_EQ(lag.seconds(), 0.0);
}

}  // namespace
}  // namespace houghstream
