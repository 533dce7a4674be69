#include "pose/seen/colour_discriminant.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/random.hpp"

namespace houghstream {
namespace {

const cv::Vec3d kRed(90.0, 170.0, 150.0);
const cv::Vec3d kGrey(130.0, 128.0, 128.0);

ColourMoments moments_about(const cv::Vec3d& lab, int count) {
  constexpr double kSpread = 4.0;
  Random random(7);
  ColourMoments moments;
  for (int i = 0; i < count; ++i) {
    cv::Vec3d colour = lab;
    for (int c = 0; c < 3; ++c) colour[c] += kSpread * random.normal();
    moments.add(cv::Vec3b(colour));
  }
  return moments;
}

TEST(ColourDiscriminant, MixturesSpeakForTheObjectByItsShare) {
  const std::optional<ColourDiscriminant> colours =
      ColourDiscriminant::between(moments_about(kRed, 500), moments_about(kGrey, 500));
  ASSERT_TRUE(colours.has_value());
  EXPECT_NEAR(colours->evidence(cv::Vec3b(kGrey)), -1.0, 0.1);
  EXPECT_NEAR(colours->evidence(cv::Vec3b(0.75 * kGrey + 0.25 * kRed)), 0.0, 0.15);
  EXPECT_NEAR(colours->evidence(cv::Vec3b(0.5 * kGrey + 0.5 * kRed)), 1.0, 0.15);
  EXPECT_EQ(colours->evidence(cv::Vec3b(kRed)), 1.0);
}

TEST(ColourDiscriminant, ColoursThatHardlyDifferOrAreFewTellNothing) {
  const ColourMoments red = moments_about(kRed, 500);
  EXPECT_FALSE(ColourDiscriminant::between(red, moments_about(kRed + cv::Vec3d(0.0, 5.0, 0.0), 500)).has_value());
  EXPECT_FALSE(ColourDiscriminant::between(red, moments_about(kGrey, 29)).has_value());
  EXPECT_FALSE(ColourDiscriminant::between(moments_about(kRed, 29), moments_about(kGrey, 500)).has_value());
}

TEST(ColourMoments, AreMeanAndCovariance) {
  ColourMoments moments;
  moments.add({10, 20, 30});
  moments.add({20, 20, 10});
  EXPECT_EQ(moments.count(), 2);
  EXPECT_TRUE(moments.mean().isApprox(Eigen::Vector3d(15.0, 20.0, 20.0)));
  Eigen::Matrix3d expected = Eigen::Matrix3d::Zero();
  expected.topLeftCorner<1, 1>() << 25.0;
  expected(2, 2) = 100.0;
  expected(0, 2) = expected(2, 0) = -50.0;
  EXPECT_TRUE(moments.covariance().isApprox(expected));
}

}  // namespace
}  // namespace houghstream
