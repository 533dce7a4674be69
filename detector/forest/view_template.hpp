#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
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
  /// Change of depth that is expected from the inner to the outer cell if the object's surface continues straight,
  /// millimetres, relative as TemplateGrid::mm; TemplateGrid::kNoDepth where it is unknown.
  std::int16_t gained_mm = 0;
};

/// Depth relative to the object's centre, and colour, on a grid of cells over a training view's box and a rim around
/// it. Cells are counted from the rim's left upper corner. Only the parts that can hold something are stored, since a
/// forest has thousands of grids.
struct TemplateGrid {
  static constexpr int kBoxSide = 20;  ///< cells per side of the box
  static constexpr int kRim = 2;       ///< cells around it
  static constexpr int kSide = kBoxSide + 2 * kRim;
  static constexpr int kRimRows = kRim + (kBoxSide * 3) / 5;  ///< number of the first rows that `beside` covers
  static constexpr std::int16_t kNoObject = -32768;           ///< the cell does not show the object
  static constexpr std::int16_t kNoDepth = -32767;            ///< it does, but no depth was measured
  [[deprecated("is kNoObject now")]] static constexpr std::int16_t kBeside = kNoObject;  ///< for one release
  /// Depth of the object, row by row from the box's first row on; as it lies across the ray to the centre, see
  /// OffAxisSlope. The columns of the rim are kNoObject.
  std::array<std::int16_t, kBoxSide * kSide> mm;
  /// Depth, millimetres, of the nearest cell of the object in the cells of the rim beside the outline, row by row from
  /// the rim's first row on; elsewhere kNoObject. Rows further down have none, since what the object stands on may
  /// touch it there.
  std::array<std::int16_t, kRimRows * kSide> beside;
  std::array<std::array<std::uint8_t, 3>, kBoxSide * kBoxSide> lab{};  ///< colour of the box's cells, 8-bit CIE L*a*b*

  /// Makes a grid that shows no object.
  TemplateGrid() {
    mm.fill(kNoObject);
    beside.fill(kNoObject);
  }

  /// Returns whether a row crosses the box.
  static constexpr bool is_in_box(int row) { return row >= kRim && row < kRim + kBoxSide; }
  /// Returns the index into `mm` of a cell whose row crosses the box.
  static constexpr std::size_t depth_index(int row, int column) {
    return static_cast<std::size_t>((row - kRim) * kSide + column);
  }
  /// Returns the index into `lab` of a cell of the box.
  static constexpr std::size_t colour_index(int row, int column) {
    return static_cast<std::size_t>((row - kRim) * kBoxSide + column - kRim);
  }
  /// Returns the depth of the object at any cell.
  std::int16_t depth_mm(int row, int column) const { return is_in_box(row) ? mm[depth_index(row, column)] : kNoObject; }
};

/// Returns the grid of a view. `mask` is CV_8UC1, 255 on the object, `box_px` its bounding box, `centre_camera` the
/// object's centre, metres.
TemplateGrid make_template_grid(const RgbdFrame& view, const cv::Mat& mask, const cv::Rect& box_px,
                                const Eigen::Vector3f& centre_camera);

/// Fills TemplateGrid::beside from the grid's depths.
void mark_rim(TemplateGrid& grid);

/// Crossings of a grid's outline at both ends of each row and column of the box.
struct TemplateOutline {
  std::array<OutlineCells, 4 * TemplateGrid::kBoxSide> crossings;
  std::size_t count = 0;  ///< number of the first crossings that are set
};
TemplateOutline find_outline(const TemplateGrid& grid);

// The names of before, for one release.
using Appearance [[deprecated("is TemplateGrid now")]] = TemplateGrid;

}  // namespace houghstream
