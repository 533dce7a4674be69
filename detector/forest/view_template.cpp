#include "detector/forest/view_template.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <utility>

#include "detector/forest/off_axis_slope.hpp"

namespace houghstream {
namespace {

constexpr int kSide = TemplateGrid::kSide;

/// A row or a column of cells.
struct Line {
  bool is_row = true;
  int number = 0;

  OutlineCells::Cell cell(int i) const {
    const auto along = static_cast<std::uint8_t>(i);
    const auto position = static_cast<std::uint8_t>(number);
    return is_row ? OutlineCells::Cell{position, along} : OutlineCells::Cell{along, position};
  }
  /// Returns TemplateGrid::mm of a cell, or kNoObject where there is no such cell.
  std::int16_t mm(const TemplateGrid& grid, int i) const {
    if (i < 0 || i >= kSide) return TemplateGrid::kNoObject;
    return is_row ? grid.depth_mm(number, i) : grid.depth_mm(i, number);
  }
};

/// Finds the crossing of the outline at `outermost`, the object's outermost cell of the line, outwards in steps of
/// `out`, 1 or -1. Returns nothing where the object is too narrow there.
std::optional<OutlineCells> find_crossing(const TemplateGrid& grid, const Line& line, int outermost, int out) {
  constexpr int kInwards = 2;  // cells to the one from which the slope of the surface is computed
  const int inside = outermost - out;
  const std::int16_t depth_mm = line.mm(grid, inside);
  if (depth_mm == TemplateGrid::kNoObject) return std::nullopt;
  OutlineCells pair{line.cell(inside), line.cell(inside + OutlineCells::kApart * out), TemplateGrid::kNoDepth};
  const std::int16_t inner_depth_mm = line.mm(grid, inside - kInwards * out);
  if (depth_mm <= TemplateGrid::kNoDepth || inner_depth_mm <= TemplateGrid::kNoDepth) return pair;
  const double gained = static_cast<double>(depth_mm - inner_depth_mm) * OutlineCells::kApart / kInwards;
  if (std::abs(gained) < 30000.0) pair.gained_mm = static_cast<std::int16_t>(std::lround(gained));
  return pair;
}

}  // namespace

TemplateGrid make_template_grid(const RgbdFrame& view, const cv::Mat& mask, const cv::Rect& box_px,
                                const Eigen::Vector3f& centre_camera) {
  const OffAxisSlope slope = off_axis_slope(centre_camera);
  const Eigen::Vector2d centre_px = view.camera.project(centre_camera.cast<double>());
  const double metres_per_px = view.camera.metres_per_px(centre_camera.z());
  TemplateGrid grid;
  cv::Mat lab;
  cv::resize(view.colour(box_px), lab, cv::Size(TemplateGrid::kBoxSide, TemplateGrid::kBoxSide), 0, 0, cv::INTER_AREA);
  cv::cvtColor(lab, lab, cv::COLOR_BGR2Lab);
  for (int j = 0; j < TemplateGrid::kBoxSide; ++j) {
    for (int i = 0; i < TemplateGrid::kBoxSide; ++i) {
      const int x = box_px.x + static_cast<int>((i + 0.5) * box_px.width / TemplateGrid::kBoxSide);
      const int y = box_px.y + static_cast<int>((j + 0.5) * box_px.height / TemplateGrid::kBoxSide);
      if (mask.at<std::uint8_t>(y, x) == 0) continue;
      const double gained = metres_per_px * (slope.right * (x - centre_px.x()) + slope.down * (y - centre_px.y()));
      const double offset_mm = 1000.0 * (view.depth.at<float>(y, x) - centre_camera.z() - gained);
      const int row = j + TemplateGrid::kRim;
      const int column = i + TemplateGrid::kRim;
      const auto& colour = lab.at<cv::Vec3b>(j, i);
      grid.lab[TemplateGrid::colour_index(row, column)] = {colour[0], colour[1], colour[2]};
      grid.mm[TemplateGrid::depth_index(row, column)] =
          std::abs(offset_mm) < 30000.0 ? static_cast<std::int16_t>(std::lround(offset_mm)) : TemplateGrid::kNoDepth;
    }
  }
  mark_rim(grid);
  return grid;
}

void mark_rim(TemplateGrid& grid) {
  grid.beside.fill(TemplateGrid::kNoObject);
  for (int j = 0; j < TemplateGrid::kRimRows; ++j) {
    for (int i = 0; i < kSide; ++i) {
      if (grid.depth_mm(j, i) != TemplateGrid::kNoObject) continue;
      int nearest_sq = 2 * TemplateGrid::kRim * TemplateGrid::kRim + 1;
      const int last_row = std::min(TemplateGrid::kRimRows - 1, j + TemplateGrid::kRim);
      for (int y = std::max(0, j - TemplateGrid::kRim); y <= last_row; ++y) {
        for (int x = std::max(0, i - TemplateGrid::kRim); x <= std::min(kSide - 1, i + TemplateGrid::kRim); ++x) {
          const std::int16_t other = grid.depth_mm(y, x);
          const int distance_sq = (x - i) * (x - i) + (y - j) * (y - j);
          if (other <= TemplateGrid::kNoDepth || distance_sq >= nearest_sq) continue;
          nearest_sq = distance_sq;
          grid.beside[static_cast<std::size_t>(j * kSide + i)] = other;
        }
      }
    }
  }
}

TemplateOutline find_outline(const TemplateGrid& grid) {
  TemplateOutline outline;
  const auto mark_ends = [&](const Line& line) {
    int first = 0;
    int last = kSide - 1;
    while (first < kSide && line.mm(grid, first) == TemplateGrid::kNoObject) ++first;
    while (last >= 0 && line.mm(grid, last) == TemplateGrid::kNoObject) --last;
    if (first > last) return;
    for (const auto& [outermost, out] : {std::pair(first, -1), std::pair(last, 1)}) {
      if (const auto pair = find_crossing(grid, line, outermost, out)) outline.crossings[outline.count++] = *pair;
    }
  };
  for (int i = TemplateGrid::kRim; i < TemplateGrid::kRim + TemplateGrid::kBoxSide; ++i) {
    mark_ends({true, i});
    mark_ends({false, i});
  }
  return outline;
}

}  // namespace houghstream
