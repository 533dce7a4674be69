#include "pose/registration/correspondence_block.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "pipeline/base/random.hpp"
#include "tests/every_target.hpp"

namespace houghstream {
namespace {

/// A rough wall 0.8 m away with holes; its rows lie apart in memory.
RgbdFrame rough_wall(cv::Mat& memory) {
  Random random(3);
  RgbdFrame frame;
  frame.camera = {80, 60, 70.0, 72.0, 39.5, 29.5};
  memory.create(60, 96, CV_32FC1);
  for (int y = 0; y < memory.rows; ++y) {
    for (int x = 0; x < memory.cols; ++x) {
      const bool hole = random.uniform() < 0.1;
      memory.at<float>(y, x) =
          hole ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(random.uniform(0.77, 0.83));
    }
  }
  frame.depth = memory(cv::Rect(0, 0, 80, 60));
  return frame;
}

/// Points about the wall, some outside the image or right before the camera.
CorrespondenceBlock points_about(std::size_t count) {
  Random random(5);
  CorrespondenceBlock block;
  block.count = count;
  for (std::size_t i = 0; i < count; ++i) {
    block.x[i] = static_cast<float>(random.uniform(-0.55, 0.55));
    block.y[i] = static_cast<float>(random.uniform(-0.45, 0.45));
    block.z[i] = i % 11 == 5 ? 1e-12F : static_cast<float>(random.uniform(0.75, 0.85));
    if (i % 22 == 5) block.x[i] = block.y[i] = 0.0F;
  }
  return block;
}

/// Pixels where a point's measured partner is looked for.
struct PointLattice {
  int u = 0;  ///< in the image
  int v = 0;
  int stride = 1;
};

/// Finds the measured partner of point `k` and writes its values to the block.
void find_one(const RgbdFrame& frame, const CorrespondenceSearch& search, const PointLattice& at, std::size_t k,
              CorrespondenceBlock& block) {
  const PixelRays rays(frame);
  for (int j = -search.steps; j <= search.steps; ++j) {
    const int y = at.v + j * at.stride;
    for (int i = -search.steps; i <= search.steps; ++i) {
      const int x = at.u + i * at.stride;
      if (x < 0 || y < 0 || x >= rays.columns || y >= rays.rows) continue;
      const float z = frame.depth.ptr<float>(y)[x];  // NaN fails the comparison below
      const Eigen::Vector3f here(z * (rays.first.x() + rays.step.x() * static_cast<float>(x)) - block.x[k],
                                 z * (rays.first.y() + rays.step.y() * static_cast<float>(y)) - block.y[k],
                                 z - block.z[k]);
      const float distance_sq = here.squaredNorm();
      if (!(distance_sq < block.distance_sq[k])) continue;
      block.distance_sq[k] = distance_sq;
      block.residual_x[k] = here.x();
      block.residual_y[k] = here.y();
      block.residual_z[k] = here.z();
    }
  }
}

/// Reference implementation of find_correspondences(), point by point.
void reference_find_correspondences(const RgbdFrame& frame, const CorrespondenceSearch& search,
                                    CorrespondenceBlock& block) {
  const PixelRays rays(frame);
  for (std::size_t k = 0; k < block.count; ++k) {
    block.distance_sq[k] = search.distance_m * search.distance_m;
    block.residual_x[k] = block.residual_y[k] = block.residual_z[k] = 0.0F;
    const Eigen::Vector3f point(block.x[k], block.y[k], block.z[k]);
    const Eigen::Vector2f pixel = frame.camera.project_single(point) + Eigen::Vector2f::Constant(0.5F);
    const bool inside = pixel.x() >= 0.5F && pixel.y() >= 0.5F && pixel.x() < static_cast<float>(rays.columns) &&
                        pixel.y() < static_cast<float>(rays.rows);
    if (!inside) continue;
    const float stride = search.distance_m / (rays.step.x() * point.z() * static_cast<float>(search.steps));
    const PointLattice at{static_cast<int>(pixel.x()), static_cast<int>(pixel.y()),
                          std::max(1, static_cast<int>(std::min(stride, PixelRays::kWidest)))};
    find_one(frame, search, at, k, block);
  }
}

/// Reference implementation of accumulate_outer_products(), row by row.
void reference_accumulate_outer_products(const ResidualRows& rows, const CorrespondenceBlock::Values& weights,
                                         std::size_t count, OuterProductSum& sums) {
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Map<const Eigen::Matrix<float, 8, 1>> row(rows[i].values.data());
    sums += (weights[i] * row) * row.transpose();
  }
}

TEST(CorrespondenceBlock, FindsTheNearestPointOfAStep) {
  RgbdFrame frame;
  frame.camera = {80, 60, 70.0, 70.0, 40.0, 30.0};
  frame.depth = cv::Mat(60, 80, CV_32FC1, cv::Scalar(0.9F));
  frame.depth.colRange(43, 80).setTo(0.8F);
  CorrespondenceBlock block;
  block.count = 2;
  block.z[0] = block.z[1] = 0.8F;
  block.x[1] = 0.3F;  // well onto the step
  find_correspondences(frame, {0.05F, 2}, block);
  EXPECT_NEAR(block.residual_x[0], 4.0 / 70.0 * 0.8,
              0.012);  // from the middle to a pixel of the lattice beyond column 43
  EXPECT_NEAR(block.residual_z[0], 0.0, 1e-6);
  EXPECT_LT(block.distance_sq[1], 0.006F * 0.006F);
}

TEST(CorrespondenceBlock, NothingWithinReachIsNoGap) {
  RgbdFrame frame;
  frame.camera = {80, 60, 70.0, 70.0, 40.0, 30.0};
  frame.depth = cv::Mat(60, 80, CV_32FC1, cv::Scalar(0.9F));
  CorrespondenceBlock block;
  block.count = 2;
  block.z[0] = block.z[1] = 0.8F;
  block.x[1] = 5.0F;  // outside the image
  find_correspondences(frame, {0.05F, 2}, block);
  for (std::size_t i = 0; i < block.count; ++i) {
    EXPECT_EQ(block.distance_sq[i], 0.05F * 0.05F);
    EXPECT_EQ(block.residual_z[i], 0.0F);
  }
}

TEST(CorrespondenceBlock, ResidualsAreThoseOfPointByPointOnEveryMachine) {
  cv::Mat memory;
  const RgbdFrame frame = rough_wall(memory);
  for (const CorrespondenceSearch search :
       {CorrespondenceSearch{0.035F, 2}, CorrespondenceSearch{0.008F, 1}, CorrespondenceSearch{0.5F, 3}}) {
    for (const std::size_t count : {std::size_t{1}, std::size_t{37}, CorrespondenceBlock::kSize}) {
      CorrespondenceBlock expected = points_about(count);
      reference_find_correspondences(frame, search, expected);
      simd::with_every_target([&] {
        CorrespondenceBlock fast = points_about(count);
        find_correspondences(frame, search, fast);
        for (std::size_t i = 0; i < count; ++i) {
          EXPECT_EQ(fast.distance_sq[i], expected.distance_sq[i]) << i;
          EXPECT_EQ(fast.residual_x[i], expected.residual_x[i]) << i;
          EXPECT_EQ(fast.residual_y[i], expected.residual_y[i]) << i;
          EXPECT_EQ(fast.residual_z[i], expected.residual_z[i]) << i;
        }
      });
    }
  }
}

TEST(CorrespondenceBlock, SumsAreThoseOfRowByRowOnEveryMachine) {
  Random random(7);
  ResidualRows rows;
  CorrespondenceBlock::Values weights;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (float& value : rows[i].values) value = static_cast<float>(random.uniform(-1.0, 1.0));
    weights[i] = static_cast<float>(random.uniform());
  }
  for (const std::size_t count : {std::size_t{0}, std::size_t{5}, rows.size()}) {
    OuterProductSum expected = OuterProductSum::Identity();
    reference_accumulate_outer_products(rows, weights, count, expected);
    simd::with_every_target([&] {
      OuterProductSum fast = OuterProductSum::Identity();
      accumulate_outer_products(rows, weights, count, fast);
      EXPECT_EQ(fast, expected);
    });
  }
}

}  // namespace
}  // namespace houghstream
