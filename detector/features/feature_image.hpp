#pragma once

#include <cstddef>
#include <cstdint>
#include <opencv2/core/types.hpp>

#include "detector/features/image_buffer.hpp"

namespace houghstream {

/// A patch as the tests see it: its centre pixel and how to get from there to the pixels around it.
struct PatchView {
  const std::uint8_t* centre = nullptr;
  std::int32_t scale = 0;  ///< working pixels per step of a test offset, in 1/256
  int row_stride = 0;      ///< bytes
  int pixel_stride = 0;    ///< bytes
};

/// Feature planes of one image, interleaved: all values of a pixel lie side by side, in one or few cache lines, since
/// a test reads one plane at two places and a patch runs many tests. The border is replicated `kPad` pixels
/// outwards, so that no test needs a clamp.
class FeatureImage {
 public:
  static constexpr int kPad = 24;   ///< pixels; test offsets are limited to this
  static constexpr int kSpare = 4;  ///< bytes behind the last pixel: it may be read as a 32-bit word

  FeatureImage() = default;
  /// Makes an image of undefined content. `pixel_stride` is the room per pixel, bytes; FeatureLayout says which of them
  /// are used.
  FeatureImage(int width, int height, int pixel_stride) { reset(width, height, pixel_stride); }
  /// Resizes the image and reuses its memory: its previous content stays, at other pixels where the size differs.
  void reset(int width, int height, int pixel_stride);

  int width() const { return width_; }
  int height() const { return height_; }
  int pixel_stride() const { return pixel_stride_; }
  int row_stride() const { return held_.width * pixel_stride_; }

  /// Returns the pixels that there are: the image and its border.
  const cv::Rect& held() const { return held_; }

  /// Returns the values of pixel (x,y), which must be one of held().
  const std::uint8_t* at(int x, int y) const { return data_.data() + offset(x, y); }
  std::uint8_t* at(int x, int y) { return data_.data() + offset(x, y); }

  PatchView patch(int x, int y, std::int32_t scale) const { return {at(x, y), scale, row_stride(), pixel_stride_}; }

  /// Fills the border from the nearest inner pixels.
  void replicate_border() { replicate_border({0, 0, width_, height_}); }
  /// Replicates the border beside a part of the image; does nothing where the part lies inside.
  void replicate_border(cv::Rect part);

 private:
  std::size_t offset(int x, int y) const {
    return static_cast<std::size_t>(y - held_.y) * row_stride() + static_cast<std::size_t>(x - held_.x) * pixel_stride_;
  }

  int width_ = 0;
  int height_ = 0;
  int pixel_stride_ = 0;
  cv::Rect held_;
  LineBytes data_;
};

}  // namespace houghstream
