#pragma once

#include <cstdint>
#include <vector>

#include "detector/features/feature_image.hpp"
#include "detector/forest/square_forest.hpp"

namespace houghstream {

/// Neighbouring patches, one at every pixel.
struct PatchSquare {
  int left = 0;  ///< working pixels
  int top = 0;
  int width = 0;  ///< patches, at most kSquareSide
  int height = 0;
};

/// Copies the pixels that a square's patches look at, plane by plane; `planes` gets layout.size() bytes.
void copy_planes(const FeatureImage& image, const PatchSquare& square, const SquareLayout& layout,
                 std::vector<std::uint8_t>& planes);

}  // namespace houghstream
