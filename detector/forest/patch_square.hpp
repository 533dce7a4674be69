#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "detector/forest/patch_grid.hpp"

namespace houghstream {

constexpr int kSquarePatches = kSquareSide * kSquareSide;

/// For scales (patch_scale): the same number where every step is rounded to the same pixels, so that patches of both
/// look at the same places.
class ScaleClasses {
 public:
  ScaleClasses(int radius, std::int32_t largest);
  std::uint16_t operator[](std::int32_t scale) const { return classes_[static_cast<std::size_t>(scale)]; }

 private:
  std::vector<std::uint16_t> classes_;
};

/// Where the pixels that a square's patches look at lie, plane by plane.
struct SquareLayout {
  SquareLayout() = default;
  SquareLayout(int reach_px, int plane_count);

  int reach = 0;         ///< pixels beyond the square on each side
  int planes = 0;        ///< and behind them one of zeros
  int row_stride = 0;    ///< bytes
  int plane_stride = 0;  ///< bytes
  /// Bytes behind the planes, which may be read past their end by a vector.
  static constexpr int kSpare = 64;
  std::size_t size() const { return static_cast<std::size_t>((planes + 1) * plane_stride + kSpare); }
};

/// Patches of a square that look at the same places around them.
struct SquareGroup {
  std::uint16_t scale_class = 0;
  std::array<std::uint32_t, kSquareSide> rows{};  ///< a bit for each patch
  /// By step_number: distance of the pixel from where the patch lies within a plane, y * row_stride + x; bytes.
  std::vector<std::int32_t> places;
};

/// Neighbouring patches, at most one at every pixel.
struct PatchSquare {
  int left = 0;  ///< working pixels
  int top = 0;
  int width = 0;  ///< pixels, at most kSquareSide
  int height = 0;
  int count = 0;  ///< patches
  SquareLayout layout;
  std::vector<SquareGroup> groups;  ///< the first group_count of them; the others' memory is used again
  std::size_t group_count = 0;
  std::array<std::uint16_t, kSquarePatches> numbers{};  ///< of the patch at y * kSquareSide + x in its run
};

/// Sorts the patches of a run, which is one of PatchGrid::squares, by their scales; `classes` holds all of these.
/// `planes`: how many the square's pixels have.
void group_patches(const PatchGrid& patches, const PatchRun& run, const ScaleClasses& classes, int radius, int planes,
                   PatchSquare& square);

}  // namespace houghstream
