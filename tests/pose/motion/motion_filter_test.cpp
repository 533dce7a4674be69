#include "pose/motion/motion_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "pipeline/base/random.hpp"
#include "pose/motion/twist.hpp"

namespace houghstream {
namespace {

Eigen::Isometry3d rotated_at(double x, double angle_rad) {
  return Eigen::Translation3d(x, 0.2, 0.3) * Eigen::AngleAxisd(angle_rad, Eigen::Vector3d(1, 2, 3).normalized());
}

PoseMeasurement measurement_of(std::int64_t utime, const Eigen::Isometry3d& T) {
  return {utime, T, 1e-6 * Covariance6::Identity()};
}

TEST(MotionFilter, WhatStandsComesToTheMeanAndKnowsItBetterAndBetter) {
  Random random(3);
  MotionFilter filter(measurement_of(0, rotated_at(0.003, 0.02)), {});
  const double first = filter.covariance()(0, 0);
  for (int i = 1; i <= 60; ++i) {
    filter.predict(i * 33333);
    filter.update(measurement_of(i * 33333, rotated_at(random.uniform(-0.003, 0.003), random.uniform(-0.02, 0.02))));
  }
  EXPECT_LT(local_coordinates_about_world(filter.T_world_object(), rotated_at(0, 0)).head<3>().norm(), 0.001);
  EXPECT_LT(filter.covariance()(0, 0), 0.15 * first);
  EXPECT_EQ(filter.velocity().norm(), 0.0);
}

TEST(MotionFilter, WhatAllFramesErrByIsWithinTwoDeviationsHoweverManyTheyAre) {
  // Three fifths of the deviation that a measurement is said to have, the same each time.
  const Eigen::Isometry3d T_seen = Eigen::Translation3d(0.0006, 0.0, 0.0) * rotated_at(0, 0);
  const MotionSettings settings;
  for (const int rate_hz : {30, 90}) {
    MotionFilter filter(measurement_of(0, T_seen), settings);
    for (int i = 1; i <= 20 * rate_hz; ++i) {
      filter.predict(i * 1000000LL / rate_hz);
      filter.update(measurement_of(i * 1000000LL / rate_hz, T_seen));
    }
    const Vector6 error = local_coordinates_about_world(filter.T_world_object(), rotated_at(0, 0));
    EXPECT_LT(error.x(), 2.0 * std::sqrt(filter.covariance()(0, 0))) << rate_hz;
    for (int i = 0; i < 6; ++i) {
      EXPECT_GT(filter.covariance()(i, i), settings.common_variance_fraction * 1e-6) << i;
      EXPECT_LT(filter.covariance()(i, i), 0.5 * 1e-6) << i;
    }
  }
}

TEST(MotionFilter, TheCommonErrorIsPartOfTheCovarianceAloneWhetherItMovesOrStands) {
  MotionSettings white;
  white.common_variance_fraction = 0.0;
  std::vector<MotionFilter> filters = {MotionFilter(measurement_of(0, rotated_at(0, 0)), {}),
                                       MotionFilter(measurement_of(0, rotated_at(0, 0)), white)};
  const auto expect_common = [&] {
    EXPECT_EQ(filters[0].T_world_object().matrix(), filters[1].T_world_object().matrix());
    const Covariance6 more = filters[0].covariance() - filters[1].covariance();
    EXPECT_TRUE(more.isApprox(MotionSettings().common_variance_fraction * 1e-6 * Covariance6::Identity(), 1e-6))
        << more;
  };
  Vector6 velocity = Vector6::Zero();
  velocity.x() = 0.3;
  for (MotionFilter& filter : filters) {
    filter.start_moving(measurement_of(0, rotated_at(0, 0)), velocity);
    for (int i = 1; i <= 60; ++i) {
      filter.predict(i * 33333);
      filter.update(measurement_of(i * 33333, rotated_at(0.01 * i, 0)));
    }
  }
  expect_common();
  for (MotionFilter& filter : filters) {
    filter.stop();
    filter.predict(63 * 33333);
    filter.update(measurement_of(63 * 33333, rotated_at(0.6, 0)));
  }
  expect_common();
}

TEST(MotionFilter, WhatMovesGoesOnForAWhileAndThenStays) {
  MotionFilter filter(measurement_of(0, rotated_at(0, 0)), {});
  Vector6 velocity = Vector6::Zero();
  velocity.x() = 0.6;
  filter.start_moving(measurement_of(0, rotated_at(0, 0)), velocity);
  filter.predict(100000);
  EXPECT_NEAR(filter.T_world_object().translation().x(), 0.06, 1e-9);
  filter.predict(2000000);
  EXPECT_NEAR(filter.T_world_object().translation().x(), 0.6 * MotionSettings().coast_s, 1e-9);
  EXPECT_GT(filter.covariance()(0, 0), 0.01);
}

}  // namespace
}  // namespace houghstream
