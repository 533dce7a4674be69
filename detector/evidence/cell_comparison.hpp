#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>

#include "detector/forest/view_template.hpp"

namespace houghstream {

/// A cell of a template. It has no values of its own: arrays of some hundred are made for each comparison, and filled.
struct TemplateCell {
  std::uint16_t index;  ///< into TemplateGrid::mm
  std::uint8_t row;
  std::uint8_t column;
};

constexpr std::size_t kTemplateSide = TemplateGrid::kSide;
constexpr std::size_t kTemplateCells = kTemplateSide * kTemplateSide;

/// One value for each cell, and room for the rest of a vector that is written behind the last.
template <typename T>
using PerCell = std::array<T, kTemplateCells + 8>;

/// Where the cells of a template lie in a frame, and the depth that the template's is counted from there.
struct CellPlaces {
  std::array<int, kTemplateSide> column_px;  ///< frame pixels that the cells' centres lie in; may lie outside
  std::array<int, kTemplateSide> row_px;
  std::array<float, kTemplateSide> row_depth;     ///< depth of the template's zero in each row, metres
  std::array<float, kTemplateSide> column_depth;  ///< amount added to row_depth in each column, metres
  float metres_per_mm = 0.001F;                   ///< metres per millimetre of template depth
};

/// Measured minus template depth at the template's cells inside the frame, row by row, metres; NaN where either is
/// missing.
struct CellDepths {
  std::size_t object_cells = 0;
  PerCell<TemplateCell> cells;  ///< the first object_cells: those on the object
  PerCell<float> excess;        ///< at these
  std::size_t beside_cells = 0;
  PerCell<float> excess_beside;  ///< the first beside_cells: in the cells beside the outline
};

/// Compares the depth of a template with that of a frame (CV_32FC1, metres, NaN where not measured), cell by cell,
/// several at once; the same on every machine. Of the rows every `row_step`-th is compared. What `out` held is
/// overwritten.
void compare_depths(const TemplateGrid& grid, const CellPlaces& places, const cv::Mat& depth, std::size_t row_step,
                    CellDepths& out);

/// Returns the median of the object's excesses within 3 cm, metres; 0 where there is none.
float common_shift(const CellDepths& depths);

/// Counts of the object's cells by how they compare.
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
  PerCell<TemplateCell> unoccluded_cells;  ///< the first `unoccluded` of them

  float fraction(std::size_t count) const {
    return static_cast<float>(count) / static_cast<float>(cells > 0 ? cells : std::size_t{1});
  }
};

/// Counts the object's cells after a shift along the ray; `shift` and `tolerance` in metres. What `tally` held is
/// overwritten.
void tally_cells(const CellDepths& depths, float shift, float tolerance, CellTally& tally);

}  // namespace houghstream
