#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "pipeline/types/frame.hpp"

namespace houghstream {

/// A frame's depth image and its camera in single precision, for many pixels.
struct PixelRays {
  explicit PixelRays(const RgbdFrame& frame)
      : focal(static_cast<float>(frame.camera.fx), static_cast<float>(frame.camera.fy)),
        centre(static_cast<float>(frame.camera.cx), static_cast<float>(frame.camera.cy)),
        first(frame.camera.backproject(0, 0, 1.0).cast<float>()),
        step((frame.camera.backproject(1, 1, 1.0) - frame.camera.backproject(0, 0, 1.0)).cast<float>()),
        columns(frame.depth.cols),
        rows(frame.depth.rows),
        row_step(static_cast<int>(frame.depth.step1())) {}

  static constexpr float kWidest = 65536.0F;  ///< pixels; more than any image has

  Eigen::Vector2f focal;   ///< pixels
  Eigen::Vector2f centre;  ///< pixels
  Eigen::Vector3f first;   ///< ray of pixel (0,0), with z = 1
  Eigen::Vector3f step;    ///< step between neighbours
  int columns;
  int rows;
  int row_step;  ///< values of depth
};

/// Some of a model's points and their correspondences, one array per coordinate; camera frame, metres.
struct CorrespondenceBlock {
  static constexpr std::size_t kSize = 64;
  using Values = std::array<float, kSize>;
  std::size_t count = 0;             ///< points that are set
  alignas(64) Values x{}, y{}, z{};  ///< z > 0
  /// Offset from the point to the measured one; 0 without.
  alignas(64) Values residual_x{}, residual_y{}, residual_z{};
  alignas(64) Values distance_sq{};  ///< square of these distances; that of CorrespondenceSearch::distance_m without
};

/// The lattice of pixels about a model point's pixel on which its measured point is searched.
struct CorrespondenceSearch {
  float distance_m = 0.0F;  ///< measured points farther away are none; the lattice reaches as far to each side
  int steps = 1;            ///< steps of the lattice to each side
};

/// Sets the residual from each of the block's points to the measured point nearest to it on its lattice. Written for
/// vector units; its test has the same point by point.
void find_correspondences(const RgbdFrame& frame, const CorrespondenceSearch& search, CorrespondenceBlock& block);

/// Eight values of a correspondence: a row of a least-squares problem.
struct alignas(32) ResidualRow {
  std::array<float, 8> values{};
};
using ResidualRows = std::array<ResidualRow, CorrespondenceBlock::kSize>;

/// Sum of weighted outer products of such rows, by columns; single precision and a width of eight suit vector units.
using OuterProductSum = Eigen::Matrix<float, 8, 8>;

/// Adds weight * row * row^T of the first `count` rows, in their order.
void accumulate_outer_products(const ResidualRows& rows, const CorrespondenceBlock::Values& weights, std::size_t count,
                               OuterProductSum& sums);

}  // namespace houghstream
