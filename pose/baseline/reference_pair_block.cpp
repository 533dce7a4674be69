#include "pose/baseline/reference_pair_block.hpp"

#include <algorithm>

namespace houghstream {
namespace {

/// Pixels where a point's measured partner is looked for.
struct PointLattice {
  int u = 0;  ///< in the image
  int v = 0;
  int stride = 1;
};

/// Of point `k`.
void find_one(const RgbdFrame& frame, const PairSearch& search, const PointLattice& at, std::size_t k,
              PairBlock& block) {
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
      block.gap_x[k] = here.x();
      block.gap_y[k] = here.y();
      block.gap_z[k] = here.z();
    }
  }
}

}  // namespace

void reference_find_gaps(const RgbdFrame& frame, const PairSearch& search, PairBlock& block) {
  const PixelRays rays(frame);
  for (std::size_t k = 0; k < block.count; ++k) {
    block.distance_sq[k] = search.distance_m * search.distance_m;
    block.gap_x[k] = block.gap_y[k] = block.gap_z[k] = 0.0F;
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

void reference_add_products(const PairRows& rows, const PairBlock::Values& weights, std::size_t count, PairSums& sums) {
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Map<const Eigen::Matrix<float, 8, 1>> row(rows[i].values.data());
    sums += (weights[i] * row) * row.transpose();
  }
}

}  // namespace houghstream
