#include "detector/evidence/template_matching.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "detector/evidence/cell_comparison.hpp"
#include "detector/evidence/colour_similarity.hpp"
#include "detector/forest/off_axis_slope.hpp"
#include "pipeline/base/no_value.hpp"

namespace houghstream {
namespace {

constexpr int kSide = TemplateGrid::kSide;

/// The cells of a template placed in the frame, and their depths.
struct Comparison {
  CellLayout layout;
  CellDepths depths;
  float left = 0.0F;  // left edge of the first cell, frame pixels
  float top = 0.0F;   // its top edge
  float cell_width = 0.0F;
  float cell_height = 0.0F;
  cv::Point2f centre_px;  // projected centre of the view, in the convention of cell_centre()
  float metres_per_px = 0.0F;

  /// Returns how far the measured surface lies behind template depth 0 (CellLayout) at a cell, metres; NaN where depth
  /// is not measured, nothing where the cell is not in the frame.
  std::optional<float> depth_behind_centre(const RgbdFrame& frame, OutlineCells::Cell cell) const {
    const cv::Point at(layout.column_px[cell.column], layout.row_px[cell.row]);
    if (!cv::Rect(cv::Point(), frame.depth.size()).contains(at)) return std::nullopt;
    return frame.depth.at<float>(at) - (layout.row_depth[cell.row] + layout.column_depth[cell.column]);
  }

  /// Returns the centre of a cell, frame pixels from the left upper edge of the first pixel.
  cv::Point2f cell_centre(std::size_t row, std::size_t column) const {
    return {left + (static_cast<float>(column) + 0.5F) * cell_width,
            top + (static_cast<float>(row) + 0.5F) * cell_height};
  }
};

/// A bit for each row or column of cells that shows a part of the object.
using LineBits = std::uint32_t;
static_assert(kSide <= 32);

/// The frame's colours at the cells of a template.
class CellColours {
 public:
  CellColours(const Comparison& comparison, const LabFrame& frame);

  const cv::Vec3b& at(std::size_t row, std::size_t column) const {
    return lab_->ptr<cv::Vec3b>(y_px_[row])[x_px_[column]];
  }

 private:
  const cv::Mat* lab_ = nullptr;
  std::array<int, kSide> x_px_;
  std::array<int, kSide> y_px_;
};

// The steps of what stands below: match_template(), UnoccludedCells and measure_boundary_continuation(). They stand
// behind these in the order of their calls.
void compare_template(const ViewTemplate& view, const Eigen::Vector3f& centre, const RgbdFrame& frame,
                      const ComparisonOptions& options, Comparison& out);
void project_cells(const ViewTemplate& view, const Eigen::Vector3f& centre, const Camera& camera, float size,
                   Comparison& out);
int floor_to_int(float value);
float depth_tolerance_at(float z);
std::size_t select_level(float cell_width, const LabLevels& levels);
void collect_colours(const CellTally& tally, const TemplateGrid& appearance, const CellColours& colours,
                     ColourPairs& pairs);
void apply_chroma_map(const ChromaMap& camera, ColourPairs& pairs);
float rim_continuation(const CellDepths& depths, float shift, float tolerance);
cv::Rect2f visible_box(const Comparison& comparison, LineBits columns, LineBits rows);
std::pair<int, int> range(LineBits seen);

}  // namespace

TemplateMatch match_template(const ViewTemplate& view, const Eigen::Vector3f& centre_camera, const LabFrame& frame,
                             const ComparisonOptions& options) {
  Comparison comparison;
  compare_template(view, centre_camera, frame.frame, options, comparison);
  const float shift = median_depth_shift(comparison.depths);
  const float tolerance = depth_tolerance_at(centre_camera.z());
  CellTally tally;
  tally_cells(comparison.depths, shift, tolerance, tally);
  ColourPairs pairs;
  collect_colours(tally, view.appearance, CellColours(comparison, frame), pairs);
  ColourSimilarity as_taught;
  as_taught.add(pairs);
  ColourSimilarity similarity = as_taught;
  if (!frame.chroma_maps.empty()) {
    apply_chroma_map(frame.chroma_maps[view.class_index], pairs);
    similarity = ColourSimilarity();
    similarity.add(pairs);
  }
  TemplateMatch fit;
  fit.depth_residual = tally.depth_residual / static_cast<float>(std::max<std::size_t>(tally.visible, 1));
  fit.visible_fraction = tally.fraction(tally.visible);
  fit.occluded_fraction = tally.fraction(tally.occluded);
  fit.free_space_violation = tally.fraction(tally.free_space_violations);
  fit.no_depth_fraction = tally.fraction(tally.no_depth);
  fit.rim_continuation = rim_continuation(comparison.depths, shift, tolerance);
  fit.colour_correlation = similarity.correlation();
  fit.mean_chroma_distance = similarity.mean_chroma_distance();
  fit.hue_mismatch = similarity.hue_mismatch();
  fit.chroma_deficit = similarity.chroma_deficit();
  fit.log_contrast_ratio = similarity.log_contrast_ratio();
  fit.colours = as_taught.means();
  fit.visible_box_px = visible_box(comparison, tally.columns, tally.rows);
  return fit;
}

UnoccludedCells::UnoccludedCells(const ViewTemplate& view, const Eigen::Vector3f& centre_camera,
                                 const RgbdFrame& frame) {
  Comparison comparison;
  compare_template(view, centre_camera, frame, {}, comparison);
  CellTally tally;
  tally_cells(comparison.depths, median_depth_shift(comparison.depths), depth_tolerance_at(centre_camera.z()), tally);
  cell_px_ = {comparison.left, comparison.top, comparison.cell_width, comparison.cell_height};
  for (std::size_t i = 0; i < tally.unoccluded; ++i)
    rows_[tally.unoccluded_cells[i].row] |= 1U << tally.unoccluded_cells[i].column;
}

float UnoccludedCells::fraction_in(const UnoccludedCells& other) const {
  int cells = 0;
  int shared = 0;
  for (int row = 0; row < kSide; ++row) {
    for (int column = 0; column < kSide; ++column) {
      if ((rows_[static_cast<std::size_t>(row)] >> column & 1U) == 0) continue;
      ++cells;
      const cv::Point2f middle(cell_px_.x + (static_cast<float>(column) + 0.5F) * cell_px_.width,
                               cell_px_.y + (static_cast<float>(row) + 0.5F) * cell_px_.height);
      shared += other.contains(middle) ? 1 : 0;
    }
  }
  return static_cast<float>(shared) / static_cast<float>(std::max(cells, 1));
}

bool UnoccludedCells::contains(const cv::Point2f& px) const {
  const float column = (px.x - cell_px_.x) / cell_px_.width;
  const float row = (px.y - cell_px_.y) / cell_px_.height;
  if (!(column >= 0.0F && row >= 0.0F && column < kSide && row < kSide)) return false;
  return (rows_[static_cast<std::size_t>(row)] >> static_cast<int>(column) & 1U) != 0;
}

BoundaryContinuation measure_boundary_continuation(const ViewTemplate& view, const Eigen::Vector3f& centre_camera,
                                                   const LabFrame& frame) {
  Comparison comparison;
  compare_template(view, centre_camera, frame.frame, {}, comparison);
  const CellColours colours(comparison, frame);
  const float shift = median_depth_shift(comparison.depths);
  const float tolerance = depth_tolerance_at(centre_camera.z());
  const TemplateGrid& appearance = view.appearance;
  BoundaryContinuation continuation;
  const TemplateOutline outline = find_outline(appearance);
  for (std::size_t i = 0; i < outline.count; ++i) {
    const OutlineCells& cells = outline.crossings[i];
    const OutlineCells::Cell in = cells.inside;
    const OutlineCells::Cell out = cells.beyond;
    const std::optional<float> inside = comparison.depth_behind_centre(frame.frame, in);
    const std::optional<float> beyond = comparison.depth_behind_centre(frame.frame, out);
    if (!inside || !beyond) continue;
    const std::int16_t mm = appearance.depth_mm(in.row, in.column);
    // a nearer surface than the template's: negative beyond the tolerance
    const bool is_occluded =
        mm > TemplateGrid::kNoDepth && *inside - comparison.layout.metres_per_mm * mm - shift < -tolerance;
    if (is_occluded) continue;
    BoundarySample sample;
    const float cell_px = in.row == out.row ? comparison.cell_width : comparison.cell_height;
    sample.lateral_distance = OutlineCells::kApart * comparison.metres_per_px * cell_px;
    sample.depth_change = *beyond - *inside;
    sample.expected_depth_change =
        cells.gained_mm > TemplateGrid::kNoDepth ? comparison.layout.metres_per_mm * cells.gained_mm : kNoValue;
    sample.colour_sq = colour_distance_sq(colours.at(in.row, in.column), colours.at(out.row, out.column));
    if (!is_foreground_step(sample, tolerance)) continuation.add(sample, tolerance);
  }
  return continuation;
}

namespace {

/// Places a template in the frame, and compares its depth there, cell by cell.
void compare_template(const ViewTemplate& view, const Eigen::Vector3f& centre, const RgbdFrame& frame,
                      const ComparisonOptions& options, Comparison& out) {
  project_cells(view, centre, frame.camera, options.size, out);
  out.metres_per_px = static_cast<float>(frame.camera.metres_per_px(centre.z()));
  CellLayout& layout = out.layout;
  layout.metres_per_mm = 0.001F * options.size;
  const OffAxisSlope slope = off_axis_slope(centre);
  for (std::size_t i = 0; i < kSide; ++i) {
    const cv::Point2f px = out.cell_centre(i, i);
    layout.column_px[i] = floor_to_int(px.x);
    layout.row_px[i] = floor_to_int(px.y);
    layout.column_depth[i] = slope.right * out.metres_per_px * (px.x - out.centre_px.x);
    layout.row_depth[i] = centre.z() + slope.down * out.metres_per_px * (px.y - out.centre_px.y);
  }
  compare_depths(view.appearance, layout, frame.depth, options.row_step, out.depths);
}

/// Computes where the template's cells lie in the frame.
void project_cells(const ViewTemplate& view, const Eigen::Vector3f& centre, const Camera& camera, float size,
                   Comparison& out) {
  const Eigen::Vector2d centre_px = camera.project(centre.cast<double>());
  // pixels per metre of the view
  const auto px_per_metre = size * static_cast<float>(1.0 / camera.metres_per_px(centre.z()));
  out.cell_width = px_per_metre * (view.box[2] - view.box[0]) / TemplateGrid::kBoxSide;
  out.cell_height = px_per_metre * (view.box[3] - view.box[1]) / TemplateGrid::kBoxSide;
  // pixel centres are whole numbers to the camera, while a box counts from the first pixel's edge
  out.centre_px = {static_cast<float>(centre_px.x()) + 0.5F, static_cast<float>(centre_px.y()) + 0.5F};
  out.left = out.centre_px.x + px_per_metre * view.box[0] - TemplateGrid::kRim * out.cell_width;
  out.top = out.centre_px.y + px_per_metre * view.box[1] - TemplateGrid::kRim * out.cell_height;
}

/// Returns std::floor(value) as an int; faster where the processor has no rounding instruction.
int floor_to_int(float value) {
  const int towards_zero = static_cast<int>(value);
  return towards_zero - (value < static_cast<float>(towards_zero) ? 1 : 0);
}

/// Returns the tolerance of depth, metres: alignment, and the noise of a structured-light camera.
float depth_tolerance_at(float z) {
  return 0.010F + 0.003F * z * z;
}

/// Returns the level whose pixels show about as much as a cell does: finer detail than that of the template is noise.
std::size_t select_level(float cell_width, const LabLevels& levels) {
  constexpr float kMeanSize_px = 3.0F;  // width, in pixels of its level, of the square whose mean a pixel is
  const int level = static_cast<int>(std::lround(std::log2(std::max(cell_width, kMeanSize_px) / kMeanSize_px)));
  return std::min(static_cast<std::size_t>(level), levels.size() - 1);
}

CellColours::CellColours(const Comparison& comparison, const LabFrame& frame) {
  const float cell_size = 0.5F * (comparison.cell_width + comparison.cell_height);
  const std::size_t level = select_level(cell_size * frame.scale, frame.lab);
  const float scale = frame.scale / static_cast<float>(1U << level);
  lab_ = &frame.lab[level];
  for (std::size_t i = 0; i < kSide; ++i) {
    const cv::Point2f px = comparison.cell_centre(i, i);
    x_px_[i] = std::clamp(static_cast<int>(px.x * scale), 0, lab_->cols - 1);
    y_px_[i] = std::clamp(static_cast<int>(px.y * scale), 0, lab_->rows - 1);
  }
}

/// Collects the colours of the cells that are visible or unknown: where depth is missing, only colour is known.
void collect_colours(const CellTally& tally, const TemplateGrid& appearance, const CellColours& colours,
                     ColourPairs& pairs) {
  pairs.count = tally.unoccluded;
  for (std::size_t i = 0; i < tally.unoccluded; ++i) {
    const TemplateCell cell = tally.unoccluded_cells[i];
    const std::array<std::uint8_t, 3>& expected = appearance.lab[cell.colour_index];
    const cv::Vec3b& observed = colours.at(cell.row, cell.column);
    for (std::size_t c = 0; c < 3; ++c) {
      pairs.expected[c][i] = expected[c];
      pairs.observed[c][i] = observed[static_cast<int>(c)];
    }
  }
}

/// Brings the expected colours to what the camera would measure in the light of the frame: ChromaMap::apply() for all
/// cells, written out so that compilers make vectors of it.
void apply_chroma_map(const ChromaMap& camera, ColourPairs& pairs) {
  constexpr float kGrey = 128.0F;
  constexpr float kLightness = 100.0F / 255.0F;  // scale from 8-bit L* to 0..100
  // The gain row by row, then the cast.
  const Eigen::Matrix<float, ChromaMap::kParameters, 1> map = camera.parameters().cast<float>();
  const auto to_byte = [](float value) {
    return static_cast<std::int16_t>(static_cast<std::int32_t>(std::clamp(value + 0.5F, 0.0F, 255.0F)));
  };
  for (std::size_t i = 0; i < pairs.count; ++i) {
    const float a = static_cast<float>(pairs.expected[1][i]) - kGrey;
    const float b = static_cast<float>(pairs.expected[2][i]) - kGrey;
    const float cast = (kLightness * static_cast<float>(pairs.observed[0][i]) + 16.0F) / 116.0F;
    pairs.expected[1][i] = to_byte(map[0] * a + map[1] * b + map[4] * cast + kGrey);
    pairs.expected[2][i] = to_byte(map[2] * a + map[3] * b + map[5] * cast + kGrey);
  }
}

/// Returns the fraction of the cells beside the outline to which the object's surface continues: a larger thing of the
/// same shape comes nearer there before it turns away.
float rim_continuation(const CellDepths& depths, float shift, float tolerance) {
  constexpr float kMaxNearer_m = 0.03F;
  int continued_count = 0;
  for (std::size_t i = 0; i < depths.rim_cells; ++i) {
    const float difference = depths.rim_difference[i] - shift;
    continued_count += (difference >= -kMaxNearer_m ? 1 : 0) & (difference <= 2.0F * tolerance ? 1 : 0);
  }
  return static_cast<float>(continued_count) / static_cast<float>(std::max<std::size_t>(depths.rim_cells, 1));
}

cv::Rect2f visible_box(const Comparison& comparison, LineBits columns, LineBits rows) {
  if (columns == 0 || rows == 0) return {};
  const auto [left, right] = range(columns);
  const auto [top, bottom] = range(rows);
  return {comparison.left + static_cast<float>(left) * comparison.cell_width,
          comparison.top + static_cast<float>(top) * comparison.cell_height,
          static_cast<float>(right - left) * comparison.cell_width,
          static_cast<float>(bottom - top) * comparison.cell_height};
}

/// Returns the first and one past the last line whose bit is set; `seen` is not 0.
std::pair<int, int> range(LineBits bits) {
  int first = 0;
  while ((bits >> first & 1U) == 0) ++first;
  int last = kSide;
  while ((bits >> (last - 1) & 1U) == 0) --last;
  return {first, last};
}

}  // namespace

}  // namespace houghstream
