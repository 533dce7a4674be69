#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>

#include "detector/forest/view_template.hpp"

namespace houghstream {

/// Identifies a cell of a template. Members have no initial values, since each comparison makes arrays of some hundred
/// cells and fills them.
struct TemplateCell {
  std::uint16_t colour_index;  ///< index into TemplateGrid::lab
  std::uint8_t row;
  std::uint8_t column;
};

constexpr std::size_t kTemplateSide = TemplateGrid::kSide;
constexpr std::size_t kTemplateCells = kTemplateSide * kTemplateSide;

/// Holds one value per cell, and room so that a whole SIMD vector may be written at the last.
template <typename T>
using PerCell = std::array<T, kTemplateCells + 8>;

/// Gives where a template's cells lie in a frame, and which measured depth corresponds to template depth 0 there. Depth
/// 0 of a template is the depth of the object's centre, across the ray (OffAxisSlope).
struct CellLayout {
  std::array<int, kTemplateSide> column_px;  ///< frame pixels of the cells' centres; may be outside the frame
  std::array<int, kTemplateSide> row_px;
  std::array<float, kTemplateSide> row_depth;     ///< measured depth of template depth 0 in each row, metres
  std::array<float, kTemplateSide> column_depth;  ///< amount added to row_depth in each column, metres
  float metres_per_mm = 0.001F;                   ///< metres per millimetre of template depth
};

/// Measured minus template depth at the template's cells inside the frame, row by row, metres; NaN where either is
/// missing.
struct CellDepths {
  std::size_t object_cells = 0;
  PerCell<TemplateCell> cells;      ///< cells on the object; the first object_cells are set
  PerCell<float> depth_difference;  ///< difference at each of these
  std::size_t rim_cells = 0;
  PerCell<float> rim_difference;  ///< difference in each cell beside the outline; the first rim_cells are set
};

/// Compares the depth of a template with that of a frame (CV_32FC1, metres, NaN where not measured), cell by cell,
/// several at once; the result is the same on every machine. Of the rows every `row_step`-th is compared. `out` is
/// overwritten.
void compare_depths(const TemplateGrid& grid, const CellLayout& layout, const cv::Mat& depth, std::size_t row_step,
                    CellDepths& out);

/// Returns the median of the object's depth differences within 3 cm, metres; 0 where there is none.
float median_depth_shift(const CellDepths& depths);

/// Counts of the object's cells by the result of the comparison.
struct CellTally {
  std::size_t cells = 0;
  std::size_t visible = 0;
  std::size_t occluded = 0;
  std::size_t free_space_violations = 0;
  std::size_t no_depth = 0;
  float depth_residual = 0.0F;             ///< sum over the visible ones, in tolerances
  std::uint32_t rows = 0;                  ///< a bit for each row with cells that are visible or unknown
  std::uint32_t columns = 0;               ///< the same of the columns
  std::size_t unoccluded = 0;              ///< number of cells that are visible or unknown
  PerCell<TemplateCell> unoccluded_cells;  ///< these cells; the first `unoccluded` are set

  float fraction(std::size_t count) const {
    return static_cast<float>(count) / static_cast<float>(cells > 0 ? cells : std::size_t{1});
  }
};

/// Counts the object's cells after a shift along the ray; `shift` and `tolerance` in metres. `tally` is
/// overwritten.
void tally_cells(const CellDepths& depths, float shift, float tolerance, CellTally& tally);

}  // namespace houghstream
