#pragma once

#include <cstdint>
#include <vector>

#include "detector/features/feature_image.hpp"
#include "detector/forest/patch_square.hpp"

namespace houghstream {

/// Copies the pixels that a square's patches look at, plane by plane; `planes` gets square.layout.size() bytes.
void copy_planes(const FeatureImage& image, const PatchSquare& square, std::vector<std::uint8_t>& planes);

}  // namespace houghstream
