#include "detector/features/feature_image.hpp"

#include <cstring>

namespace houghstream {

FeatureImage::FeatureImage(int width, int height, int pixel_stride)
    : width_(width),
      height_(height),
      pixel_stride_(pixel_stride),
      data_(static_cast<std::size_t>(width + 2 * kPad) * static_cast<std::size_t>(height + 2 * kPad) * pixel_stride +
            kSpare) {}

void FeatureImage::replicate_border() {
  const auto pixel_bytes = static_cast<std::size_t>(pixel_stride_);
  for (int y = 0; y < height_; ++y) {
    for (int p = 1; p <= kPad; ++p) {
      std::memcpy(at(-p, y), at(0, y), pixel_bytes);
      std::memcpy(at(width_ - 1 + p, y), at(width_ - 1, y), pixel_bytes);
    }
  }
  const auto row_bytes = static_cast<std::size_t>(row_stride());
  for (int p = 1; p <= kPad; ++p) {
    std::memcpy(at(-kPad, -p), at(-kPad, 0), row_bytes);
    std::memcpy(at(-kPad, height_ - 1 + p), at(-kPad, height_ - 1), row_bytes);
  }
}

}  // namespace houghstream
