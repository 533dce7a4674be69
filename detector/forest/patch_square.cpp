#include "detector/forest/patch_square.hpp"

#include <algorithm>

#include "detector/forest/square_forest.hpp"

namespace houghstream {
namespace {

int to_px(int step, std::int32_t scale) {  // as patch_offset
  return (step * scale + 128) >> 8;
}

bool rounds_alike(std::int32_t a, std::int32_t b, int radius) {
  for (int step = 1; step <= radius; ++step) {
    if (to_px(step, a) != to_px(step, b) || to_px(-step, a) != to_px(-step, b)) return false;
  }
  return true;
}

/// The box that the patches stand in.
void find_box(const PatchGrid& patches, const PatchRun& run, PatchSquare& square) {
  const auto first = static_cast<std::ptrdiff_t>(run.first);
  const auto last = static_cast<std::ptrdiff_t>(run.first + run.count);
  const auto [left, right] = std::minmax_element(patches.x.begin() + first, patches.x.begin() + last);
  square.left = *left;
  square.top = patches.y[run.first];
  square.width = *right - *left + 1;
  square.height = patches.y[run.first + run.count - 1] - square.top + 1;
}

/// Number of the group of a class; a new one where there is none.
std::size_t group_of(std::uint16_t scale_class, PatchSquare& square) {
  std::size_t group = 0;
  while (group < square.group_count && square.groups[group].scale_class != scale_class) ++group;
  if (group < square.group_count) return group;
  if (group == square.groups.size()) square.groups.emplace_back();
  square.groups[group].scale_class = scale_class;
  square.groups[group].rows.fill(0);
  ++square.group_count;
  return group;
}

void list_places(std::int32_t scale, int radius, const SquareLayout& layout, std::vector<std::int32_t>& places) {
  places.clear();
  const int centre = layout.reach * layout.row_stride + layout.reach;
  for (int dy = -radius; dy <= radius; ++dy) {
    const int row = centre + to_px(dy, scale) * layout.row_stride;
    for (int dx = -radius; dx <= radius; ++dx) places.push_back(row + to_px(dx, scale));
  }
}

}  // namespace

ScaleClasses::ScaleClasses(int radius, std::int32_t largest) : classes_(static_cast<std::size_t>(largest) + 1) {
  for (std::int32_t scale = 1; scale <= largest; ++scale) {
    const std::uint16_t last = classes_[static_cast<std::size_t>(scale) - 1];
    const bool alike = rounds_alike(scale - 1, scale, radius);
    classes_[static_cast<std::size_t>(scale)] = static_cast<std::uint16_t>(last + (alike ? 0 : 1));
  }
}

SquareLayout::SquareLayout(int reach_px, int plane_count)
    : reach(reach_px),
      planes(plane_count),
      row_stride(kSquareSide + 2 * reach_px),
      plane_stride(row_stride * row_stride) {}

void group_patches(const PatchGrid& patches, const PatchRun& run, const ScaleClasses& classes, int radius, int planes,
                   PatchSquare& square) {
  find_box(patches, run, square);
  square.count = static_cast<int>(run.count);
  square.group_count = 0;
  std::array<std::int32_t, kSquarePatches> scales;  // of the groups
  std::size_t group = 0;
  std::int32_t largest = 0;
  for (std::size_t i = 0; i < run.count; ++i) {
    const std::size_t p = run.first + i;
    const std::uint16_t scale_class = classes[patches.scale[p]];
    if (square.group_count == 0 || square.groups[group].scale_class != scale_class) {
      group = group_of(scale_class, square);
      scales[group] = patches.scale[p];
      largest = std::max(largest, patches.scale[p]);
    }
    const int x = patches.x[p] - square.left;
    const int y = patches.y[p] - square.top;
    square.groups[group].rows[static_cast<std::size_t>(y)] |= 1U << x;
    square.numbers[static_cast<std::size_t>(y * kSquareSide + x)] = static_cast<std::uint16_t>(i);
  }
  square.layout = SquareLayout(to_px(radius, largest), planes);
  for (std::size_t g = 0; g < square.group_count; ++g) {
    list_places(scales[g], radius, square.layout, square.groups[g].places);
  }
}

}  // namespace houghstream
