#include "detector/view_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace houghstream {
namespace {

constexpr int kSide = Relief::kSide;

/// Where the cells of a relief are seen, and how much farther than remembered the frame's surface is there.
struct Comparison {
  std::array<float, kSide * kSide> excess{};         // on the object, metres; NaN where depth is not measured or not remembered
  std::array<float, kSide * kSide> excess_beside{};  // beside its outline
  std::array<bool, kSide * kSide> on_object{};
  std::array<bool, kSide * kSide> beside{};
  float left = 0.0F;  // of the first cell, frame pixels
  float top = 0.0F;
  float cell_width = 0.0F;
  float cell_height = 0.0F;
};

Comparison compare(const TrainedView& view, const Eigen::Vector3f& centre, const RgbdFrame& frame) {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  Comparison out;
  const Eigen::Vector2d centre_px = frame.camera.project(centre.cast<double>());
  const auto px_per_metre = static_cast<float>(1.0 / frame.camera.metres_per_px(centre.z()));
  out.cell_width = px_per_metre * (view.box[2] - view.box[0]) / Relief::kBoxSide;
  out.cell_height = px_per_metre * (view.box[3] - view.box[1]) / Relief::kBoxSide;
  // pixel centres are whole numbers to the camera, while a box counts from the first pixel's edge
  out.left = static_cast<float>(centre_px.x()) + 0.5F + px_per_metre * view.box[0] - Relief::kRim * out.cell_width;
  out.top = static_cast<float>(centre_px.y()) + 0.5F + px_per_metre * view.box[1] - Relief::kRim * out.cell_height;
  for (int j = 0; j < kSide; ++j) {
    for (int i = 0; i < kSide; ++i) {
      const auto cell = static_cast<std::size_t>(j * kSide + i);
      const int x = static_cast<int>(std::floor(out.left + (static_cast<float>(i) + 0.5F) * out.cell_width));
      const int y = static_cast<int>(std::floor(out.top + (static_cast<float>(j) + 0.5F) * out.cell_height));
      if (x < 0 || y < 0 || x >= frame.depth.cols || y >= frame.depth.rows) continue;
      const float beyond_centre = frame.depth.at<float>(y, x) - centre.z();
      const std::int16_t remembered = view.relief.mm[cell];
      const std::int16_t neighbour = view.relief.beside[cell];
      out.on_object[cell] = remembered != Relief::kBeside;
      out.beside[cell] = neighbour != Relief::kBeside;
      out.excess[cell] = remembered > Relief::kNoDepth ? beyond_centre - 0.001F * remembered : kNone;
      out.excess_beside[cell] = neighbour > Relief::kNoDepth ? beyond_centre - 0.001F * neighbour : kNone;
    }
  }
  return out;
}

/// Median of what lies within reach of the expected depth.
float common_shift(const Comparison& comparison) {
  constexpr float kReach = 0.03F;
  std::vector<float> near;
  for (const float e : comparison.excess) {
    if (std::abs(e) < kReach) near.push_back(e);
  }
  if (near.empty()) return 0.0F;
  const auto middle = near.begin() + static_cast<std::ptrdiff_t>(near.size() / 2);
  std::nth_element(near.begin(), middle, near.end());
  return *middle;
}

/// First and one past the last line in which enough of the object's cells are seen.
std::pair<int, int> seen_range(const std::array<int, kSide>& seen, const std::array<int, kSide>& whole) {
  constexpr int kOneIn = 5;
  int first = kSide;
  int last = 0;
  for (int i = 0; i < kSide; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (seen[at] == 0 || seen[at] * kOneIn < whole[at]) continue;
    first = std::min(first, i);
    last = i + 1;
  }
  return {first, last};
}

}  // namespace

ViewFit fit_view(const TrainedView& view, const Eigen::Vector3f& centre_camera, const RgbdFrame& frame) {
  const Comparison comparison = compare(view, centre_camera, frame);
  const float shift = common_shift(comparison);
  const float z = centre_camera.z();
  const float tolerance = 0.010F + 0.003F * z * z;  // alignment, and a structured-light camera's noise
  ViewFit fit;
  std::array<int, kSide> rows{};
  std::array<int, kSide> columns{};
  std::array<int, kSide> whole_rows{};
  std::array<int, kSide> whole_columns{};
  int cells = 0;
  int beside = 0;
  for (std::size_t cell = 0; cell < comparison.excess.size(); ++cell) {
    if (comparison.beside[cell]) {
      ++beside;
      fit.continued += std::abs(comparison.excess_beside[cell] - shift) <= tolerance ? 1.0F : 0.0F;
    }
    if (!comparison.on_object[cell]) continue;
    ++cells;
    const float e = comparison.excess[cell] - shift;
    const bool unknown = std::isnan(e);
    const bool visible = std::abs(e) <= tolerance;
    fit.unknown += unknown ? 1.0F : 0.0F;
    fit.visible += visible ? 1.0F : 0.0F;
    fit.hidden += e < -tolerance ? 1.0F : 0.0F;
    fit.seen_through += e > tolerance ? 1.0F : 0.0F;
    ++whole_rows[cell / kSide];
    ++whole_columns[cell % kSide];
    rows[cell / kSide] += unknown || visible ? 1 : 0;
    columns[cell % kSide] += unknown || visible ? 1 : 0;
  }
  fit.continued /= static_cast<float>(std::max(beside, 1));
  if (cells == 0) return fit;
  for (float* share : {&fit.visible, &fit.hidden, &fit.seen_through, &fit.unknown}) *share /= static_cast<float>(cells);
  const auto [left, right] = seen_range(columns, whole_columns);
  const auto [top, bottom] = seen_range(rows, whole_rows);
  if (left < right && top < bottom) {
    fit.visible_box_px = {comparison.left + static_cast<float>(left) * comparison.cell_width,
                          comparison.top + static_cast<float>(top) * comparison.cell_height,
                          static_cast<float>(right - left) * comparison.cell_width,
                          static_cast<float>(bottom - top) * comparison.cell_height};
  }
  return fit;
}

namespace {

/// The cells beside the outline, each with the depth of the nearest cell of the object. Not below the object's upper
/// part: what it stands on may touch it there.
void mark_rim(Relief& relief) {
  constexpr int kUpper = Relief::kRim + (Relief::kBoxSide * 3) / 5;
  relief.beside.fill(Relief::kBeside);
  for (int j = 0; j < kUpper; ++j) {
    for (int i = 0; i < kSide; ++i) {
      const auto cell = static_cast<std::size_t>(j * kSide + i);
      if (relief.mm[cell] != Relief::kBeside) continue;
      int nearest_sq = 2 * Relief::kRim * Relief::kRim + 1;
      for (int y = std::max(0, j - Relief::kRim); y <= std::min(kUpper - 1, j + Relief::kRim); ++y) {
        for (int x = std::max(0, i - Relief::kRim); x <= std::min(kSide - 1, i + Relief::kRim); ++x) {
          const std::int16_t other = relief.mm[static_cast<std::size_t>(y * kSide + x)];
          const int distance_sq = (x - i) * (x - i) + (y - j) * (y - j);
          if (other <= Relief::kNoDepth || distance_sq >= nearest_sq) continue;
          nearest_sq = distance_sq;
          relief.beside[cell] = other;
        }
      }
    }
  }
}

}  // namespace

Relief make_relief(const cv::Mat& depth, const cv::Mat& mask, const cv::Rect& box_px, double centre_depth) {
  Relief relief;
  relief.mm.fill(Relief::kBeside);
  for (int j = 0; j < Relief::kBoxSide; ++j) {
    for (int i = 0; i < Relief::kBoxSide; ++i) {
      const int x = box_px.x + static_cast<int>((i + 0.5) * box_px.width / Relief::kBoxSide);
      const int y = box_px.y + static_cast<int>((j + 0.5) * box_px.height / Relief::kBoxSide);
      if (mask.at<std::uint8_t>(y, x) == 0) continue;
      const double offset_mm = 1000.0 * (depth.at<float>(y, x) - centre_depth);
      relief.mm[static_cast<std::size_t>((j + Relief::kRim) * kSide + i + Relief::kRim)] =
          std::abs(offset_mm) < 30000.0 ? static_cast<std::int16_t>(std::lround(offset_mm)) : Relief::kNoDepth;
    }
  }
  mark_rim(relief);
  return relief;
}

}  // namespace houghstream
