#pragma once

#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace houghstream {

/// Feature planes of one picture, interleaved: all values of a pixel lie in one 64-byte cache line, since a test
/// reads one plane at two places and a patch runs many tests. The border is replicated `kPad` pixels
/// outwards, so that no test needs a clamp.
class FeatureImage {
 public:
  static constexpr int kChannels = 64;  ///< room per pixel; FeatureLayout says which are used
  static constexpr int kPad = 24;       ///< pixels; test offsets are limited to this

  FeatureImage() = default;
  FeatureImage(int width, int height);

  int width() const { return width_; }
  int height() const { return height_; }
  int row_stride() const { return (width_ + 2 * kPad) * kChannels; }

  /// The 64 values of pixel (x,y); valid from -kPad to size + kPad - 1.
  const std::uint8_t* at(int x, int y) const { return data_.data() + offset(x, y); }
  std::uint8_t* at(int x, int y) { return data_.data() + offset(x, y); }

  /// Fills the border from the nearest inner pixels.
  void replicate_border();

 private:
  std::size_t offset(int x, int y) const {
    return static_cast<std::size_t>(y + kPad) * row_stride() + static_cast<std::size_t>(x + kPad) * kChannels;
  }

  int width_ = 0;
  int height_ = 0;
  std::vector<std::uint8_t> data_;
};

}  // namespace houghstream
