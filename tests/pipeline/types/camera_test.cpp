#include "pipeline/types/camera.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "pipeline/base/checks.hpp"

namespace houghstream {
namespace {

const Camera kUnequalFocals{640, 480, 525.0, 520.0, 319.5, 239.5};

TEST(Camera, BackprojectionInvertsProjection) {
  const Eigen::Vector3d point(0.3, -0.2, 1.7);
  const Eigen::Vector2d pixel = kUnequalFocals.project(point);
  EXPECT_NEAR((kUnequalFocals.backproject(pixel.x(), pixel.y(), 1.7) - point).norm(), 0.0, 1e-12);
}

TEST(Camera, ScaledCameraSeesTheSameRays) {
  const Camera half = kUnequalFocals.scaled(0.5);
  EXPECT_EQ(half.width, 320);
  // The centre of the 2x2 block (0,0)-(1,1) is pixel (0,0) of the half-size image.
  const Eigen::Vector3d full_ray = kUnequalFocals.backproject(0.5, 0.5, 1.0);
  EXPECT_NEAR((half.backproject(0.0, 0.0, 1.0) - full_ray).norm(), 0.0, 1e-12);
}

TEST(Camera, CroppedCameraSeesTheSameRays) {
  const Camera crop = kUnequalFocals.cropped(100, 50, 64, 48);
  EXPECT_NEAR((crop.backproject(3, 4, 2.0) - kUnequalFocals.backproject(103, 54, 2.0)).norm(), 0.0, 1e-12);
}

TEST(Camera, AbsurdNumbersAreRefused) {
  Camera bad = kUnequalFocals;
  bad.fx = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(check_camera(bad, "test"), InputError);
  bad = kUnequalFocals;
  bad.width = 0;
  EXPECT_THROW(check_camera(bad, "test"), InputError);
  bad = kUnequalFocals;
  for (const double focal : {1e-300, 1e300}) {
    bad.fy = focal;
    EXPECT_THROW(check_camera(bad, "test"), InputError) << focal;
  }
  bad = kUnequalFocals;
  bad.cx = 1e9;
  EXPECT_THROW(check_camera(bad, "test"), InputError);
  EXPECT_NO_THROW(check_camera(kUnequalFocals, "test"));
}

TEST(Camera, OptionIsParsedWholeOrRefused) {
  EXPECT_EQ(parse_camera("640x480,525,520,319.5,239.5"), kUnequalFocals);
  EXPECT_THROW(parse_camera("640x480,525,520,319.5"), InputError);
  EXPECT_THROW(parse_camera("640x480,525,520,319.5,239.5,1"), InputError);
  EXPECT_THROW(parse_camera("640x480,-525,520,319.5,239.5"), InputError);
}

}  // namespace
}  // namespace houghstream
