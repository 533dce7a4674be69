#include "detector/features/feature_image.hpp"

#include <cstring>

namespace houghstream {

void FeatureImage::reset(int width, int height, int pixel_stride) {
  width_ = width;
  height_ = height;
  pixel_stride_ = pixel_stride;
  held_ = {-kPad, -kPad, width + 2 * kPad, height + 2 * kPad};
  const std::size_t size = static_cast<std::size_t>(held_.height) * static_cast<std::size_t>(row_stride()) + kSpare;
  if (data_.size() < size) data_.resize(size);
}

void FeatureImage::replicate_border(cv::Rect part) {
  const auto pixel_bytes = static_cast<std::size_t>(pixel_stride_);
  const bool left = part.x == 0;
  const bool right = part.x + part.width == width_;
  for (int y = part.y; y < part.y + part.height; ++y) {
    for (int p = 1; p <= kPad; ++p) {
      if (left) std::memcpy(at(-p, y), at(0, y), pixel_bytes);
      if (right) std::memcpy(at(width_ - 1 + p, y), at(width_ - 1, y), pixel_bytes);
    }
  }
  const int begin = left ? -kPad : part.x;
  const int end = right ? width_ + kPad : part.x + part.width;
  const std::size_t row_bytes = static_cast<std::size_t>(end - begin) * pixel_bytes;
  for (int p = 1; p <= kPad; ++p) {
    if (part.y == 0) std::memcpy(at(begin, -p), at(begin, 0), row_bytes);
    if (part.y + part.height == height_) std::memcpy(at(begin, height_ - 1 + p), at(begin, height_ - 1), row_bytes);
  }
}

}  // namespace houghstream
