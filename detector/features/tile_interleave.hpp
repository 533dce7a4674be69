#pragma once

#include "detector/features/feature_image.hpp"
#include "detector/features/tile_plane.hpp"

namespace houghstream {

/// Writes a part's planes into an image, pixel by pixel; `rows` have room for image.pixel_stride() planes.
void interleave_planes(const TileRows& rows, cv::Rect part, FeatureImage& image);

}  // namespace houghstream
