#include "detector/evidence/template_matching.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "detector/evidence/colour_similarity.hpp"
#include "detector/forest/off_axis_slope.hpp"
#include "pipeline/base/no_value.hpp"

namespace houghstream {
namespace {

constexpr int kSide = TemplateGrid::kSide;

struct Cell {
  std::uint16_t index = 0;  // index into the depth template
  std::uint8_t row = 0;
  std::uint8_t column = 0;
};

/// The cells of a template placed in the frame, and how much farther than in the template the frame's surface is there.
/// Only cells within the frame, row by row.
struct Comparison {
  std::size_t object_cells = 0;
  std::array<Cell, kSide * kSide> cells;  // the first object_cells: those on the object
  // Excess at these cells, metres; NaN where depth is unknown in the frame or in the template.
  std::array<float, kSide * kSide> excess;
  std::size_t beside_cells = 0;
  std::array<float, kSide * kSide> excess_beside;  // the first beside_cells: beside the outline
  std::array<int, kSide> column_px{};              // frame pixels that the cells' centres lie in
  std::array<int, kSide> row_px{};
  std::array<float, kSide>
      row_depth{};  // depth that the depth template is counted from, in a row at the centre's column...
  std::array<float, kSide> column_depth{};  // ...and more in a column
  float left = 0.0F;                        // left side of the first cell, frame pixels
  float top = 0.0F;
  float cell_width = 0.0F;
  float cell_height = 0.0F;
  cv::Point2f centre_px;  // centre of the view, as cell_centre()
  float metres_per_px = 0.0F;
  float metres_per_mm = 0.0F;  // of the view

  /// Returns how far the measured surface lies behind the template's zero at a cell, metres; NaN where depth is not
  /// measured, nothing where the cell is not in the frame.
  std::optional<float> beyond_centre(const RgbdFrame& frame, OutlineCells::Cell cell) const {
    const cv::Point at(column_px[cell.column], row_px[cell.row]);
    if (!cv::Rect(cv::Point(), frame.depth.size()).contains(at)) return std::nullopt;
    return frame.depth.at<float>(at) - (row_depth[cell.row] + column_depth[cell.column]);
  }

  /// Returns the centre of a cell, frame pixels from the left upper edge of the first pixel.
  cv::Point2f cell_centre(std::size_t row, std::size_t column) const {
    return {left + (static_cast<float>(column) + 0.5F) * cell_width,
            top + (static_cast<float>(row) + 0.5F) * cell_height};
  }
};

/// A bit for each row or column of cells that shows a part of the object.
using Lines = std::uint32_t;
static_assert(kSide <= 32);

/// Counts of the object's cells by how they compare.
struct Tally {
  std::size_t cells = 0;
  int visible = 0;
  int occluded = 0;
  int free_space_violations = 0;
  int no_depth = 0;
  float depth_residual = 0.0F;  // sum over the visible ones
  Lines rows = 0;               // rows with cells that are visible or unknown
  Lines columns = 0;
  std::size_t unoccluded = 0;                        // number of cells that are visible or unknown
  std::array<Cell, kSide * kSide> unoccluded_cells;  // the first `unoccluded` of them

  float fraction(int count) const {
    return static_cast<float>(count) / static_cast<float>(std::max<std::size_t>(cells, 1));
  }
};

/// The frame's colours at the cells of a template.
class CellColours {
 public:
  CellColours(const Comparison& comparison, const LabFrame& frame);

  const cv::Vec3b& at(std::size_t row, std::size_t column) const {
    return lab_->ptr<cv::Vec3b>(y_px_[row])[x_px_[column]];
  }

 private:
  const cv::Mat* lab_ = nullptr;
  std::array<int, kSide> x_px_{};
  std::array<int, kSide> y_px_{};
};

// The steps of the two functions below; they stand behind them in the order of their calls.
Comparison compare(const ViewTemplate& view, const Eigen::Vector3f& centre, const RgbdFrame& frame, float size);
void place(const ViewTemplate& view, const Eigen::Vector3f& centre, const Camera& camera, float size, Comparison& out);
float common_shift(const Comparison& comparison);
float tolerance_at(float z);
Tally tally_cells(const Comparison& comparison, float shift, float tolerance);
std::size_t level_of(float cell_width, const LabLevels& levels);
ColourSimilarity compare_colours(const Tally& tally, const TemplateGrid& appearance, const CellColours& colours);
ColourSimilarity compare_camera_colours(const Tally& tally, const TemplateGrid& appearance, const CellColours& colours,
                                        const ChromaMap& camera);
float rim_continuation(const Comparison& comparison, float shift, float tolerance);
cv::Rect2f visible_box(const Comparison& comparison, Lines columns, Lines rows);
std::pair<int, int> range(Lines seen);

}  // namespace

TemplateMatch match_template(const ViewTemplate& view, const Eigen::Vector3f& centre_camera, const LabFrame& frame,
                             float size) {
  const Comparison comparison = compare(view, centre_camera, frame.frame, size);
  const float shift = common_shift(comparison);
  const float tolerance = tolerance_at(centre_camera.z());
  const Tally tally = tally_cells(comparison, shift, tolerance);
  const CellColours colours(comparison, frame);
  const ColourSimilarity as_taught = compare_colours(tally, view.appearance, colours);
  const ColourSimilarity similarity =
      frame.cameras.empty() ? as_taught
                            : compare_camera_colours(tally, view.appearance, colours, frame.cameras[view.class_index]);
  TemplateMatch fit;
  fit.depth_residual = tally.depth_residual / static_cast<float>(std::max(tally.visible, 1));
  fit.visible_fraction = tally.fraction(tally.visible);
  fit.occluded_fraction = tally.fraction(tally.occluded);
  fit.free_space_violation = tally.fraction(tally.free_space_violations);
  fit.no_depth_fraction = tally.fraction(tally.no_depth);
  fit.rim_continuation = rim_continuation(comparison, shift, tolerance);
  fit.colour_correlation = similarity.correlation();
  fit.mean_chroma_distance = similarity.mean_chroma_distance();
  fit.hue_mismatch = similarity.hue_mismatch();
  fit.chroma_deficit = similarity.chroma_deficit();
  fit.log_contrast_ratio = similarity.log_contrast_ratio();
  fit.colours = as_taught.means();
  fit.visible_box_px = visible_box(comparison, tally.columns, tally.rows);
  return fit;
}

BoundaryContinuation measure_boundary_continuation(const ViewTemplate& view, const Eigen::Vector3f& centre_camera,
                                                   const LabFrame& frame) {
  const Comparison comparison = compare(view, centre_camera, frame.frame, 1.0F);
  const CellColours colours(comparison, frame);
  const float shift = common_shift(comparison);
  const float tolerance = tolerance_at(centre_camera.z());
  const TemplateGrid& appearance = view.appearance;
  BoundaryContinuation fit;
  for (const OutlineCells& cells : appearance.outline) {
    const OutlineCells::Cell in = cells.inside;
    const OutlineCells::Cell out = cells.beyond;
    if (in.row == 0) break;
    const std::optional<float> inside = comparison.beyond_centre(frame.frame, in);
    const std::optional<float> beyond = comparison.beyond_centre(frame.frame, out);
    if (!inside || !beyond) continue;
    const std::int16_t mm = appearance.mm[in.row * kSide + in.column];
    const bool is_hidden = mm > TemplateGrid::kNoDepth && *inside - comparison.metres_per_mm * mm - shift < -tolerance;
    if (is_hidden) continue;
    BoundarySample sample;
    const float cell_px = in.row == out.row ? comparison.cell_width : comparison.cell_height;
    sample.lateral_distance = OutlineCells::kApart * comparison.metres_per_px * cell_px;
    sample.depth_change = *beyond - *inside;
    sample.expected_depth_change =
        cells.gained_mm > TemplateGrid::kNoDepth ? comparison.metres_per_mm * cells.gained_mm : kNoValue;
    sample.colour_sq = colour_distance_sq(colours.at(in.row, in.column), colours.at(out.row, out.column));
    if (!is_foreground_step(sample, tolerance)) fit.add(sample, tolerance);
  }
  return fit;
}

namespace {

/// Compares a template with the frame cell by cell, without branches on the cells' kind, which would be mispredicted.
Comparison compare(const ViewTemplate& view, const Eigen::Vector3f& centre, const RgbdFrame& frame, float size) {
  Comparison out;
  place(view, centre, frame.camera, size, out);
  out.metres_per_mm = 0.001F * size;
  out.metres_per_px = static_cast<float>(frame.camera.metres_per_px(centre.z()));
  const float metres_per_mm = out.metres_per_mm;
  const float metres_per_px = out.metres_per_px;
  const OffAxisSlope tilt = off_axis_slope(centre);
  for (std::size_t i = 0; i < kSide; ++i) {
    const cv::Point2f px = out.cell_centre(i, i);
    out.column_px[i] = static_cast<int>(std::floor(px.x));
    out.row_px[i] = static_cast<int>(std::floor(px.y));
    out.column_depth[i] = tilt.right * metres_per_px * (px.x - out.centre_px.x);
    out.row_depth[i] = centre.z() + tilt.down * metres_per_px * (px.y - out.centre_px.y);
  }
  std::array<float, kSide> expected{};  // depth that the depth template is counted from, in a row
  for (std::size_t row = 0; row < kSide; ++row) {
    const int y = out.row_px[row];
    if (y < 0 || y >= frame.depth.rows) continue;
    const auto* depth = frame.depth.ptr<float>(y);
    for (std::size_t column = 0; column < kSide; ++column)
      expected[column] = out.row_depth[row] + out.column_depth[column];
    for (std::size_t column = 0; column < kSide; ++column) {
      const int x = out.column_px[column];
      if (x < 0 || x >= frame.depth.cols) continue;
      const std::size_t cell = row * kSide + column;
      const float beyond_centre = depth[x] - expected[column];
      const std::int16_t template_mm = view.appearance.mm[cell];
      const std::int16_t neighbour = view.appearance.beside[cell];
      out.cells[out.object_cells] = {static_cast<std::uint16_t>(cell), static_cast<std::uint8_t>(row),
                                     static_cast<std::uint8_t>(column)};
      out.excess[out.object_cells] =
          template_mm > TemplateGrid::kNoDepth ? beyond_centre - metres_per_mm * template_mm : kNoValue;
      out.object_cells += template_mm != TemplateGrid::kBeside ? 1 : 0;
      out.excess_beside[out.beside_cells] =
          neighbour > TemplateGrid::kNoDepth ? beyond_centre - metres_per_mm * neighbour : kNoValue;
      out.beside_cells += neighbour != TemplateGrid::kBeside ? 1 : 0;
    }
  }
  return out;
}

/// Computes where the template's cells lie in the frame.
void place(const ViewTemplate& view, const Eigen::Vector3f& centre, const Camera& camera, float size, Comparison& out) {
  const Eigen::Vector2d centre_px = camera.project(centre.cast<double>());
  const auto px_per_metre = size * static_cast<float>(1.0 / camera.metres_per_px(centre.z()));  // of the view
  out.cell_width = px_per_metre * (view.box[2] - view.box[0]) / TemplateGrid::kBoxSide;
  out.cell_height = px_per_metre * (view.box[3] - view.box[1]) / TemplateGrid::kBoxSide;
  // pixel centres are whole numbers to the camera, while a box counts from the first pixel's edge
  out.centre_px = {static_cast<float>(centre_px.x()) + 0.5F, static_cast<float>(centre_px.y()) + 0.5F};
  out.left = out.centre_px.x + px_per_metre * view.box[0] - TemplateGrid::kRim * out.cell_width;
  out.top = out.centre_px.y + px_per_metre * view.box[1] - TemplateGrid::kRim * out.cell_height;
}

/// Returns the median of the depth differences within reach. Only the class of a histogram that holds it is searched:
/// searching all of them mispredicts a branch for about every second value.
float common_shift(const Comparison& comparison) {
  constexpr float kReach = 0.03F;
  constexpr int kClasses = 64;
  std::array<float, kSide * kSide> near;
  std::array<std::uint8_t, kSide * kSide> classes;
  std::array<std::size_t, kClasses + 1> counts{};  // the last: out of reach
  const std::size_t cells = comparison.object_cells;
  for (std::size_t i = 0; i < cells; ++i) {
    const float e = comparison.excess[i];
    const bool within = std::abs(e) < kReach;
    const float position = within ? (e + kReach) * (kClasses / (2.0F * kReach)) : 0.0F;
    const int bin = within ? std::min(static_cast<int>(position), kClasses - 1) : kClasses;
    classes[i] = static_cast<std::uint8_t>(bin);
    ++counts[static_cast<std::size_t>(bin)];
  }
  const std::size_t total = cells - counts[kClasses];
  if (total == 0) return 0.0F;
  std::size_t rank = total / 2;
  std::size_t middle = 0;
  for (; rank >= counts[middle]; ++middle) rank -= counts[middle];
  std::size_t count = 0;
  for (std::size_t i = 0; i < cells; ++i) {
    near[count] = comparison.excess[i];
    count += classes[i] == middle ? 1 : 0;
  }
  auto* const median = near.data() + rank;
  std::nth_element(near.data(), median, near.data() + count);
  return *median;
}

/// Returns the tolerance of depth, metres: alignment, and the noise of a structured-light camera.
float tolerance_at(float z) {
  return 0.010F + 0.003F * z * z;
}

/// Counts the cells by how they compare, after a shift along the ray, without branches, as compare().
Tally tally_cells(const Comparison& comparison, float shift, float tolerance) {
  Tally tally;
  tally.cells = comparison.object_cells;
  for (std::size_t i = 0; i < comparison.object_cells; ++i) {
    const Cell cell = comparison.cells[i];
    const float e = comparison.excess[i] - shift;
    const int no_depth = std::isnan(e) ? 1 : 0;
    const int visible = std::abs(e) <= tolerance ? 1 : 0;
    const int seen = visible | no_depth;
    tally.unoccluded_cells[tally.unoccluded] = cell;
    tally.unoccluded += static_cast<std::size_t>(seen);
    tally.depth_residual += visible != 0 ? std::abs(e) / tolerance : 0.0F;
    tally.visible += visible;
    tally.no_depth += no_depth;
    tally.occluded += e < -tolerance ? 1 : 0;
    tally.free_space_violations += e > tolerance ? 1 : 0;
    tally.rows |= static_cast<Lines>(seen) << cell.row;
    tally.columns |= static_cast<Lines>(seen) << cell.column;
  }
  return tally;
}

/// Returns the level whose pixels show about as much as a cell does: finer detail than that of the template is noise.
std::size_t level_of(float cell_width, const LabLevels& levels) {
  constexpr float kAveraged = 3.0F;  // pixels of a level: what each of them is the mean of
  const int level = static_cast<int>(std::lround(std::log2(std::max(cell_width, kAveraged) / kAveraged)));
  return std::min(static_cast<std::size_t>(level), levels.size() - 1);
}

CellColours::CellColours(const Comparison& comparison, const LabFrame& frame) {
  const float cell_size = 0.5F * (comparison.cell_width + comparison.cell_height);
  const std::size_t level = level_of(cell_size * frame.scale, frame.lab);
  const float scale = frame.scale / static_cast<float>(1U << level);
  lab_ = &frame.lab[level];
  for (std::size_t i = 0; i < kSide; ++i) {
    const cv::Point2f px = comparison.cell_centre(i, i);
    x_px_[i] = std::clamp(static_cast<int>(px.x * scale), 0, lab_->cols - 1);
    y_px_[i] = std::clamp(static_cast<int>(px.y * scale), 0, lab_->rows - 1);
  }
}

/// Compares the colours of the cells that are visible or unknown: where depth is missing, only colour is known.
ColourSimilarity compare_colours(const Tally& tally, const TemplateGrid& appearance, const CellColours& colours) {
  ColourSimilarity similarity;
  for (std::size_t i = 0; i < tally.unoccluded; ++i) {
    const Cell cell = tally.unoccluded_cells[i];
    similarity.add(appearance.lab[cell.index], colours.at(cell.row, cell.column));
  }
  return similarity;
}

/// Compares the colours as compare_colours() does, with the template's colours as the camera would measure them in the
/// light of the frame.
ColourSimilarity compare_camera_colours(const Tally& tally, const TemplateGrid& appearance, const CellColours& colours,
                                        const ChromaMap& camera) {
  constexpr double kGrey = 128.0;
  constexpr double kLightness = 100.0 / 255.0;  // factor from 8-bit L* to L*
  ColourSimilarity similarity;
  for (std::size_t i = 0; i < tally.unoccluded; ++i) {
    const Cell cell = tally.unoccluded_cells[i];
    const cv::Vec3b& seen = colours.at(cell.row, cell.column);
    const std::array<std::uint8_t, 3>& lab = appearance.lab[cell.index];
    const Eigen::Vector2d ab = camera.apply({lab[1] - kGrey, lab[2] - kGrey}, kLightness * seen[0]);
    similarity.add(
        {lab[0], cv::saturate_cast<std::uint8_t>(ab.x() + kGrey), cv::saturate_cast<std::uint8_t>(ab.y() + kGrey)},
        seen);
  }
  return similarity;
}

/// Returns the fraction of the cells beside the outline to which the object's surface continues: a larger thing of the
/// same shape comes nearer there before it turns away.
float rim_continuation(const Comparison& comparison, float shift, float tolerance) {
  constexpr float kNearer = 0.03F;
  int continued = 0;
  for (std::size_t i = 0; i < comparison.beside_cells; ++i) {
    const float e = comparison.excess_beside[i] - shift;
    continued += (e >= -kNearer ? 1 : 0) & (e <= 2.0F * tolerance ? 1 : 0);
  }
  return static_cast<float>(continued) / static_cast<float>(std::max<std::size_t>(comparison.beside_cells, 1));
}

cv::Rect2f visible_box(const Comparison& comparison, Lines columns, Lines rows) {
  if (columns == 0 || rows == 0) return {};
  const auto [left, right] = range(columns);
  const auto [top, bottom] = range(rows);
  return {comparison.left + static_cast<float>(left) * comparison.cell_width,
          comparison.top + static_cast<float>(top) * comparison.cell_height,
          static_cast<float>(right - left) * comparison.cell_width,
          static_cast<float>(bottom - top) * comparison.cell_height};
}

/// Returns the first and one past the last line whose bit is set; `seen` is not 0.
std::pair<int, int> range(Lines seen) {
  int first = 0;
  while ((seen >> first & 1U) == 0) ++first;
  int last = kSide;
  while ((seen >> (last - 1) & 1U) == 0) --last;
  return {first, last};
}

}  // namespace

}  // namespace houghstream
