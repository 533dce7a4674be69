#include "tools/evaluate/metrics/bop_errors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace houghstream {
namespace {

const std::vector<Eigen::Isometry3d> kNoSymmetry = {Eigen::Isometry3d::Identity()};
const Camera kHundredWide = {100, 80, 100.0, 100.0, 49.5, 39.5};

/// Returns a square of 0.2 m, facing a camera that looks along z.
Mesh square() {
  Mesh mesh;
  mesh.vertices = {{-0.1F, -0.1F, 0}, {0.1F, -0.1F, 0}, {0.1F, 0.1F, 0}, {-0.1F, 0.1F, 0}};
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}};
  return mesh;
}

Eigen::Isometry3d at(double x, double y, double z) {
  return Eigen::Isometry3d(Eigen::Translation3d(x, y, z));
}

/// Returns a frame with the same measured depth everywhere, metres.
RgbdFrame wall(float depth) {
  RgbdFrame frame;
  frame.camera = kHundredWide;
  frame.depth = cv::Mat(kHundredWide.height, kHundredWide.width, CV_32FC1, cv::Scalar(depth));
  return frame;
}

TEST(BopErrors, TheFarthestVertexCounts) {
  const auto vertices = square().vertices;
  EXPECT_NEAR(mssd_error(vertices, kNoSymmetry, at(0.003, 0, 1.004), at(0, 0, 1)), 0.005, 1e-9);
  // A tenth of a radian about the left edge's middle moves the right edge by 2 * 0.2 sin(0.05).
  const Eigen::Isometry3d rotated = at(-0.1, 0, 1) * Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitY()) * at(0.1, 0, 0);
  EXPECT_NEAR(mssd_error(vertices, kNoSymmetry, rotated, at(0, 0, 1)), 0.4 * std::sin(0.05), 1e-6);
}

TEST(BopErrors, InTheImageADistanceIsSmallerTheFartherItIs) {
  const auto vertices = square().vertices;
  EXPECT_NEAR(mspd_error(vertices, kNoSymmetry, at(0.02, 0, 2), at(0, 0, 2), kHundredWide), 1.0, 1e-6);
  // The plate is nearer by half, so that the corners go from 5 to 10 pixels off the centre, along both axes.
  EXPECT_NEAR(mspd_error(vertices, kNoSymmetry, at(0, 0, 1), at(0, 0, 2), kHundredWide), 5.0 * std::sqrt(2.0), 1e-5);
  EXPECT_TRUE(std::isinf(mspd_error(vertices, kNoSymmetry, at(0, 0, -1), at(0, 0, 2), kHundredWide)));
  EXPECT_TRUE(std::isinf(mspd_error(vertices, kNoSymmetry, at(0, 0, 1), at(0, 0, 0), kHundredWide)));
}

TEST(BopErrors, TheBestOfTheEquivalentPosesCounts) {
  const auto vertices = square().vertices;
  std::vector<Eigen::Isometry3d> quarters;
  quarters.reserve(4);
  for (int i = 0; i < 4; ++i) quarters.emplace_back(Eigen::AngleAxisd(i * M_PI / 2, Eigen::Vector3d::UnitZ()));
  const Eigen::Isometry3d rotated = at(0.01, 0, 1) * Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ());
  EXPECT_NEAR(mssd_error(vertices, kNoSymmetry, rotated, at(0, 0, 1)), 0.21, 2e-3)
      << "a corner goes to the next, 0.2 m";
  EXPECT_NEAR(mssd_error(vertices, quarters, rotated, at(0, 0, 1)), 0.01, 1e-7);
  EXPECT_NEAR(mspd_error(vertices, quarters, rotated, at(0, 0, 1), kHundredWide), 1.0, 1e-4);
}

TEST(BopErrors, VsdOfATruePoseIsNothing) {
  for (const double error : vsd_errors(square(), 0.3, at(0, 0, 1), at(0, 0, 1), wall(1.0F))) EXPECT_EQ(error, 0.0);
}

TEST(BopErrors, VsdCountsSurfacesThatAreTooFarApart) {
  // The pose is 0.05 m too far, of a diameter of 0.4 m: 0.125 diameters, beyond the taus 0.05 and 0.1. Both poses cover
  // the same 20 x 20 pixels: 19.05 pixels of width still reach the outermost centres.
  const auto errors = vsd_errors(square(), 0.4, at(0, 0, 1.05), at(0, 0, 1), wall(1.0F));
  for (std::size_t i = 0; i < errors.size(); ++i) EXPECT_EQ(errors[i], i < 2 ? 1.0 : 0.0) << bop_step(i);
  // Too far by 0.25 m, 0.625 diameters, it covers 16 x 16 of them.
  const auto farther = vsd_errors(square(), 0.4, at(0, 0, 1.25), at(0, 0, 1), wall(1.0F));
  for (const double error : farther) EXPECT_EQ(error, 1.0);
  const auto large = vsd_errors(square(), 1.0, at(0, 0, 1.25), at(0, 0, 1), wall(1.0F));
  EXPECT_NEAR(large[9], 1.0 - 256.0 / 400.0, 1e-12) << "0.25 diameters of a larger object: only the rim is wrong";
}

TEST(BopErrors, VsdCountsPixelsThatSeeTheObjectInOnePoseOnly) {
  // The pose is off by half its width to the side, so that a third of the union is in both.
  const auto errors = vsd_errors(square(), 0.3, at(0.1, 0, 1), at(0, 0, 1), wall(1.0F));
  for (const double error : errors) EXPECT_NEAR(error, 2.0 / 3.0, 1e-6);
  const auto apart = vsd_errors(square(), 0.3, at(0.25, 0, 1), at(0, 0, 1), wall(1.0F));
  for (const double error : apart) EXPECT_EQ(error, 1.0);
}

TEST(BopErrors, VsdLooksOnlyAtWhatIsVisible) {
  // The right half is hidden by something 0.5 m in front; the estimate is wrong there only.
  RgbdFrame frame = wall(1.0F);
  frame.depth.colRange(50, 100).setTo(0.5F);
  const auto hidden = vsd_errors(square(), 0.3, at(0.1, 0, 1), at(0, 0, 1), frame);
  for (const double error : hidden) EXPECT_EQ(error, 1.0) << "10 columns of the truth, none of the estimate";
  const auto half = vsd_errors(square(), 0.3, at(0, 0, 1), at(0, 0, 1), frame);
  for (const double error : half) EXPECT_EQ(error, 0.0);
  // Up to 15 mm in front of it, what was measured hides nothing.
  EXPECT_EQ(vsd_errors(square(), 0.3, at(0, 0, 1), at(0, 0, 1), wall(0.9855F))[0], 0.0);
  EXPECT_EQ(vsd_errors(square(), 0.3, at(0, 0, 1), at(0, 0, 1), wall(0.98F))[0], 1.0) << "nothing visible";
}

TEST(BopErrors, WhereNoDepthWasMeasuredTheObjectCountsAsVisible) {
  const RgbdFrame nothing = wall(std::numeric_limits<float>::quiet_NaN());
  const auto errors = vsd_errors(square(), 0.3, at(0.1, 0, 1), at(0, 0, 1), nothing);
  for (const double error : errors) EXPECT_NEAR(error, 2.0 / 3.0, 1e-6);
}

TEST(BopErrors, VsdOfAPoseOutsideTheImageIsOne) {
  EXPECT_EQ(vsd_errors(square(), 0.3, at(5, 0, 1), at(6, 0, 1), wall(1.0F))[9], 1.0);
  EXPECT_EQ(vsd_errors(square(), 0.3, at(0, 0, -1), at(0, 0, 1), wall(1.0F))[9], 1.0) << "behind the camera";
}

TEST(BopErrors, ErrorsAreFreeOfUnits) {
  const BopModel model = {square(), 0.4, kNoSymmetry};
  const BopErrors errors = bop_errors(model, at(0.02, 0, 1), at(0, 0, 1), wall(1.0F));
  EXPECT_NEAR(errors.mssd, 0.05, 1e-6);
  EXPECT_NEAR(errors.mspd, 2.0 * 6.4, 1e-4) << "2 pixels of an image 100 wide";
}

}  // namespace
}  // namespace houghstream
