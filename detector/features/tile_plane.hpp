#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "detector/features/image_buffer.hpp"

namespace houghstream {

constexpr int kMaxPart = 128;      ///< pixels side by side, at most
constexpr int kWidestMargin = 40;  ///< around a part, at most
/// Pixels of the widest row, with room for vectors past its end.
constexpr int kWidestRow = kMaxPart + 2 * kWidestMargin + 2 * 64;

/// Values of a part of an image, and of some pixels around it. Rows may be read and written a vector past their end.
template <typename T>
class TilePlane {
 public:
  static constexpr int kVector = 64;  ///< values, at most, that are handled together

  /// Makes room for `part` and `margin` pixels around it; what is in there is undefined. Keeps its memory.
  void reset(cv::Size part, int margin) {
    width_ = part.width;
    height_ = part.height;
    margin_ = margin;
    stride_ = (part.width + 2 * margin + kVector - 1) / kVector * kVector + kVector;
    const auto size = static_cast<std::size_t>(stride_ * (part.height + 2 * margin) + kVector);
    if (data_.size() < size) data_.resize(size);
  }

  int width() const { return width_; }
  int height() const { return height_; }
  int margin() const { return margin_; }
  int stride() const { return stride_; }  ///< values

  /// Returns row y of the part, from -margin on; its values are valid from -margin on too.
  const T* row(int y) const { return data_.data() + (y + margin_) * stride_ + margin_; }
  T* row(int y) { return data_.data() + (y + margin_) * stride_ + margin_; }

  /// Values outside of `inside`, which is counted from the part's first pixel, become those of the nearest one inside.
  void extend(cv::Rect inside) {
    const int left = std::max(inside.x, -margin_);
    const int right = std::min(inside.x + inside.width, width_ + margin_);
    const int top = std::max(inside.y, -margin_);
    const int bottom = std::min(inside.y + inside.height, height_ + margin_);
    for (int y = top; y < bottom; ++y) {
      std::fill(row(y) - margin_, row(y) + left, row(y)[left]);
      std::fill(row(y) + right, row(y) + width_ + margin_, row(y)[right - 1]);
    }
    const auto copy = [&](int from, int to) {
      std::copy_n(row(from) - margin_, width_ + 2 * margin_, row(to) - margin_);
    };
    for (int y = -margin_; y < top; ++y) copy(top, y);
    for (int y = bottom; y < height_ + margin_; ++y) copy(bottom - 1, y);
  }

  /// Takes its values from an image, of which the part begins at `at`.
  void load(const cv::Mat& image, cv::Point at) {
    const int left = std::max(-margin_, -at.x);
    const int right = std::min(width_ + margin_, image.cols - at.x);
    for (int y = std::max(-margin_, -at.y); y < std::min(height_ + margin_, image.rows - at.y); ++y) {
      std::copy_n(image.ptr<T>(at.y + y) + at.x + left, right - left, row(y) + left);
    }
    extend({-at.x, -at.y, image.cols, image.rows});
  }

 private:
  int width_ = 0;
  int height_ = 0;
  int margin_ = 0;
  int stride_ = 0;
  std::vector<T> data_;
};

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
