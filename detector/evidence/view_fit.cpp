#include "detector/evidence/view_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "detector/evidence/likeness.hpp"
#include "detector/features/picture_memory.hpp"

namespace houghstream {
namespace {

constexpr int kSide = Appearance::kSide;

/// Where the cells of a relief are seen, and how much farther than remembered the frame's surface is there.
struct Comparison {
  std::array<float, kSide * kSide>
      excess{};  // on the object, metres; NaN where depth is not measured or not remembered
  std::array<float, kSide * kSide> excess_beside{};  // beside its outline
  std::array<bool, kSide * kSide> on_object{};
  std::array<bool, kSide * kSide> beside{};
  float left = 0.0F;  // of the first cell, frame pixels
  float top = 0.0F;
  float cell_width = 0.0F;
  float cell_height = 0.0F;

  /// Frame pixels from the left upper edge of the first pixel.
  cv::Point2f cell_centre(std::size_t cell) const {
    const std::size_t column = cell % kSide;
    const std::size_t row = cell / kSide;
    return {left + (static_cast<float>(column) + 0.5F) * cell_width,
            top + (static_cast<float>(row) + 0.5F) * cell_height};
  }
};

Comparison compare(const TrainedView& view, const Eigen::Vector3f& centre, const RgbdFrame& frame, float size) {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  Comparison out;
  const Eigen::Vector2d centre_px = frame.camera.project(centre.cast<double>());
  const auto px_per_metre = size * static_cast<float>(1.0 / frame.camera.metres_per_px(centre.z()));  // of the view
  const float metres = 0.001F * size;  // per millimetre of it
  out.cell_width = px_per_metre * (view.box[2] - view.box[0]) / Appearance::kBoxSide;
  out.cell_height = px_per_metre * (view.box[3] - view.box[1]) / Appearance::kBoxSide;
  // pixel centres are whole numbers to the camera, while a box counts from the first pixel's edge
  out.left = static_cast<float>(centre_px.x()) + 0.5F + px_per_metre * view.box[0] - Appearance::kRim * out.cell_width;
  out.top = static_cast<float>(centre_px.y()) + 0.5F + px_per_metre * view.box[1] - Appearance::kRim * out.cell_height;
  std::array<int, kSide> column_px{};
  for (std::size_t column = 0; column < kSide; ++column)
    column_px[column] = static_cast<int>(std::floor(out.cell_centre(column).x));
  for (std::size_t row = 0; row < kSide; ++row) {
    const int y = static_cast<int>(std::floor(out.cell_centre(row * kSide).y));
    if (y < 0 || y >= frame.depth.rows) continue;
    const auto* depth = frame.depth.ptr<float>(y);
    for (std::size_t column = 0; column < kSide; ++column) {
      const int x = column_px[column];
      if (x < 0 || x >= frame.depth.cols) continue;
      const std::size_t cell = row * kSide + column;
      const float beyond_centre = depth[x] - centre.z();
      const std::int16_t remembered = view.appearance.mm[cell];
      const std::int16_t neighbour = view.appearance.beside[cell];
      out.on_object[cell] = remembered != Appearance::kBeside;
      out.beside[cell] = neighbour != Appearance::kBeside;
      out.excess[cell] = remembered > Appearance::kNoDepth ? beyond_centre - metres * remembered : kNone;
      out.excess_beside[cell] = neighbour > Appearance::kNoDepth ? beyond_centre - metres * neighbour : kNone;
    }
  }
  return out;
}

/// Median of what lies in the frame and within reach of the expected depth.
float common_shift(const Comparison& comparison) {
  constexpr float kReach = 0.03F;
  std::array<float, kSide * kSide> near;
  std::size_t count = 0;
  for (std::size_t cell = 0; cell < near.size(); ++cell) {
    near[count] = comparison.excess[cell];
    count += comparison.on_object[cell] && std::abs(near[count]) < kReach ? 1 : 0;
  }
  if (count == 0) return 0.0F;
  auto* middle = near.data() + count / 2;
  std::nth_element(near.data(), middle, near.data() + count);
  return *middle;
}

/// Which rows or columns of cells show some of the object.
using Lines = std::array<bool, kSide>;

/// First and one past the last line that does.
std::pair<int, int> range(const Lines& seen) {
  int first = kSide;
  int last = 0;
  for (int i = 0; i < kSide; ++i) {
    if (!seen[static_cast<std::size_t>(i)]) continue;
    first = std::min(first, i);
    last = i + 1;
  }
  return {first, last};
}

cv::Rect2f visible_box(const Comparison& comparison, const Lines& columns, const Lines& rows) {
  const auto [left, right] = range(columns);
  const auto [top, bottom] = range(rows);
  if (left >= right || top >= bottom) return {};
  return {comparison.left + static_cast<float>(left) * comparison.cell_width,
          comparison.top + static_cast<float>(top) * comparison.cell_height,
          static_cast<float>(right - left) * comparison.cell_width,
          static_cast<float>(bottom - top) * comparison.cell_height};
}

/// Share of the cells beside the outline whose surface goes on from the object's: a larger thing of the same shape
/// comes nearer there before it turns away.
float continued_share(const Comparison& comparison, float shift, float tolerance) {
  constexpr float kNearer = 0.03F;
  int beside = 0;
  int continued = 0;
  for (std::size_t cell = 0; cell < comparison.beside.size(); ++cell) {
    if (!comparison.beside[cell]) continue;
    ++beside;
    const float e = comparison.excess_beside[cell] - shift;
    continued += e >= -kNearer && e <= 2.0F * tolerance ? 1 : 0;
  }
  return static_cast<float>(continued) / static_cast<float>(std::max(beside, 1));
}

/// How the object's cells compare.
struct Tally {
  int cells = 0;
  int visible = 0;
  int hidden = 0;
  int seen_through = 0;
  int unknown = 0;
  float unevenness = 0.0F;  // sum over the visible ones
  Lines rows{};             // with cells that are visible or unknown
  Lines columns{};
  std::size_t shown = 0;                                 // cells in front of which nothing is known to be
  std::array<std::uint16_t, kSide * kSide> shown_cells;  // the first `shown` of them

  float share(int count) const { return static_cast<float>(count) / static_cast<float>(std::max(cells, 1)); }
};

/// Without branches, which nobody could predict.
Tally tally_cells(const Comparison& comparison, float shift, float tolerance) {
  Tally tally;
  for (std::size_t row = 0; row < kSide; ++row) {
    for (std::size_t column = 0; column < kSide; ++column) {
      const std::size_t cell = row * kSide + column;
      const int object = comparison.on_object[cell] ? 1 : 0;
      const float e = comparison.excess[cell] - shift;
      const int unknown = object & (std::isnan(e) ? 1 : 0);
      const int visible = object & (std::abs(e) <= tolerance ? 1 : 0);
      tally.shown_cells[tally.shown] = static_cast<std::uint16_t>(cell);
      tally.shown += static_cast<std::size_t>(visible | unknown);
      tally.unevenness += visible != 0 ? std::abs(e) / tolerance : 0.0F;
      tally.cells += object;
      tally.visible += visible;
      tally.unknown += unknown;
      tally.hidden += object & (e < -tolerance ? 1 : 0);
      tally.seen_through += object & (e > tolerance ? 1 : 0);
      const bool seen = (unknown | visible) != 0;
      tally.rows[row] = tally.rows[row] || seen;
      tally.columns[column] = tally.columns[column] || seen;
    }
  }
  return tally;
}

/// Of the cells that are visible or unknown: where depth is missing, colours are all there is to see.
Likeness compare_colours(const Comparison& comparison, const Tally& tally, const Appearance& appearance,
                         const LabFrame& frame) {
  std::array<int, kSide> x_px{};
  std::array<int, kSide> y_px{};
  for (std::size_t i = 0; i < kSide; ++i) {
    const cv::Point2f px = comparison.cell_centre(i * kSide + i);
    x_px[i] = std::min(static_cast<int>(px.x * frame.scale), frame.lab.cols - 1);
    y_px[i] = std::min(static_cast<int>(px.y * frame.scale), frame.lab.rows - 1);
  }
  Likeness likeness;
  for (std::size_t i = 0; i < tally.shown; ++i) {
    const std::size_t cell = tally.shown_cells[i];
    likeness.add(appearance.lab[cell], frame.lab.ptr<cv::Vec3b>(y_px[cell / kSide])[x_px[cell % kSide]]);
  }
  return likeness;
}

}  // namespace

LabFrame make_lab_frame(const RgbdFrame& frame, const cv::Mat& colour, float scale) {
  static thread_local cv::Mat blurred;  // both kept from frame to frame
  static thread_local cv::Mat lab;
  forget_shared(lab);
  cv::blur(colour, blurred, cv::Size(3, 3));
  cv::cvtColor(blurred, lab, cv::COLOR_BGR2Lab);
  return {frame, lab, scale};
}

ViewFit fit_view(const TrainedView& view, const Eigen::Vector3f& centre_camera, const LabFrame& frame, float size) {
  const Comparison comparison = compare(view, centre_camera, frame.frame, size);
  const float shift = common_shift(comparison);
  const float z = centre_camera.z();
  const float tolerance = 0.010F + 0.003F * z * z;  // alignment, and a structured-light camera's noise
  const Tally tally = tally_cells(comparison, shift, tolerance);
  const Likeness likeness = compare_colours(comparison, tally, view.appearance, frame);
  ViewFit fit;
  fit.unevenness = tally.unevenness / static_cast<float>(std::max(tally.visible, 1));
  fit.visible = tally.share(tally.visible);
  fit.hidden = tally.share(tally.hidden);
  fit.seen_through = tally.share(tally.seen_through);
  fit.unknown = tally.share(tally.unknown);
  fit.continued = continued_share(comparison, shift, tolerance);
  fit.likeness = likeness.correlation();
  fit.foreign_colour = likeness.foreign_colour();
  fit.hue_conflict = likeness.hue_conflict();
  fit.visible_box_px = visible_box(comparison, tally.columns, tally.rows);
  return fit;
}

}  // namespace houghstream
