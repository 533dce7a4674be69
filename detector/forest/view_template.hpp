#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "pipeline/types/frame.hpp"

namespace houghstream {

/// Two cells of one row or one column, on both sides of a view's boundary.
struct OutlineCells {
  struct Cell {
    std::uint8_t row = 0;
    std::uint8_t column = 0;
  };
  static constexpr int kApart = 3;  ///< cells
  Cell inside;                      ///< the object's, one cell in from its outline
  Cell beyond;                      ///< cell two cells outside the outline
  /// Expected change of depth from the inner to the outer cell if the object's surface continues straight, millimetres,
  /// relative as TemplateGrid::mm; TemplateGrid::kNoDepth where it is unknown.
  std::int16_t gained_mm = 0;
};

/// Depth relative to the object's centre, and colour, on a grid of cells over a training view's box and a rim around
/// it.
struct TemplateGrid {
  static constexpr int kBoxSide = 20;  ///< cells per side of the box
  static constexpr int kRim = 2;       ///< cells around it
  static constexpr int kSide = kBoxSide + 2 * kRim;
  static constexpr std::int16_t kBeside = -32768;   ///< the cell does not show the object
  static constexpr std::int16_t kNoDepth = -32767;  ///< it does, but no depth was measured
  using Cells = std::array<std::int16_t, kSide * kSide>;
  Cells mm{};      ///< row by row; as it lies across the ray to the centre, see OffAxisSlope
  Cells beside{};  ///< depth of the nearest cell of the object in cells beside the outline; elsewhere kBeside
  std::array<std::array<std::uint8_t, 3>, kSide * kSide> lab{};  ///< colour, 8-bit CIE L*a*b*; of the object only
  /// Crossings of the outline at both ends of each row and column. Where those are fewer, one from row 0 ends them: the
  /// rim never shows the object.
  std::array<OutlineCells, 4 * kBoxSide> outline{};
};

/// Returns the grid of a view. `mask` is CV_8UC1, 255 on the object, `box_px` its bounding box, `centre_camera` the
/// object's centre, metres.
TemplateGrid make_template_grid(const RgbdFrame& view, const cv::Mat& mask, const cv::Rect& box_px,
                                const Eigen::Vector3f& centre_camera);

// The names of before, for one release.
using Appearance [[deprecated("is TemplateGrid now")]] = TemplateGrid;

}  // namespace houghstream
