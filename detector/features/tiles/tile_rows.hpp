#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

#include "detector/features/line_allocator.hpp"

namespace houghstream {

/// All planes of a part of an image: of each row its planes, one after another.
class TileRows {
 public:
  /// Makes room; what is in there is undefined. Keeps its memory.
  void reset(cv::Size part, int planes) {
    planes_ = planes;
    stride_ = (part.width + kVector - 1) / kVector * kVector;
    data_.resize(static_cast<std::size_t>(part.height * planes * stride_));
  }

  int stride() const { return stride_; }  ///< bytes from plane to plane: whole vectors
  std::uint8_t* row(int y, int plane) { return data_.data() + (y * planes_ + plane) * stride_; }
  const std::uint8_t* row(int y, int plane) const { return data_.data() + (y * planes_ + plane) * stride_; }

 private:
  static constexpr int kVector = 64;

  int planes_ = 0;
  int stride_ = 0;
  LineBytes data_;
};

}  // namespace houghstream
