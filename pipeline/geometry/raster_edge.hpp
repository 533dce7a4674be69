#pragma once

#include <algorithm>
#include <cstdint>

// Integer edge functions for the rasteriser follow Pineda, "A Parallel Algorithm for Polygon Rasterization" (1988):
// vertices are snapped to 1/256 pixel, so that a pixel centre on the edge between two triangles belongs to exactly one
// of them.

namespace houghstream {

constexpr int kSubpixelBits = 8;
constexpr int kSubpixels = 1 << kSubpixelBits;

/// Holds a point of the image on the snapping grid.
struct Snapped {
  std::int64_t x = 0;  // 1/256 pixel
  std::int64_t y = 0;
};

/// E(x, y) >= 0 holds for the pixels inside; the bias excludes pixel centres on edges that the neighbour owns.
struct Edge {
  Edge(const Snapped& a, const Snapped& b)
      : x_step(-(b.y - a.y) * kSubpixels),
        y_step((b.x - a.x) * kSubpixels),
        origin((b.y - a.y) * a.x - (b.x - a.x) * a.y) {
    const bool owns_its_pixels = x_step < 0 || (x_step == 0 && y_step > 0);
    if (!owns_its_pixels) --origin;
  }

  std::int64_t at(int x, int y) const { return origin + x_step * x + y_step * y; }

  std::int64_t x_step;
  std::int64_t y_step;
  std::int64_t origin;
};

/// An edge of a wide triangle, whose rows are cut at once, not pixel by pixel.
struct ClippingEdge : Edge {
  ClippingEdge(const Edge& edge)  // NOLINT(google-explicit-constructor): the same edge
      : Edge(edge), inverse_x_step(x_step == 0 ? 0.0 : 1.0 / static_cast<double>(x_step)) {}

  /// Narrows first..last to the pixels of row y that lie inside.
  void clip(int y, int& first, int& last) const {
    const std::int64_t row = origin + y_step * y;
    if (x_step == 0) {
      if (row < 0) last = first - 1;
      return;
    }
    const double crossing = -static_cast<double>(row) * inverse_x_step;
    if (x_step > 0) {  // inside is right of the crossing
      if (crossing <= first - 1.0) return;
      if (crossing >= last + 1.0) {
        last = first - 1;
        return;
      }
      int x = static_cast<int>(crossing);
      while (row + x_step * x >= 0) --x;
      while (row + x_step * x < 0) ++x;
      first = std::max(first, x);
    } else {
      if (crossing >= last + 1.0) return;
      if (crossing <= first - 1.0) {
        last = first - 1;
        return;
      }
      int x = static_cast<int>(crossing);
      while (row + x_step * x >= 0) ++x;
      while (row + x_step * x < 0) --x;
      last = std::min(last, x);
    }
  }

  double inverse_x_step;
};

}  // namespace houghstream
