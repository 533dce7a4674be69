#pragma once

#include <algorithm>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace houghstream {

/// The parts of a FeatureImage that are read, in tiles of kSide pixels.
class FeatureTiles {
 public:
  static constexpr int kSide = 32;  ///< pixels

  FeatureTiles() = default;

  /// Marks no tile of an image of this size as wanted. Keeps its memory.
  void clear(cv::Size image);
  /// Marks all tiles of an image of this size as wanted.
  void want_all(cv::Size image);
  /// Marks the tiles that a patch at (x,y), inside the image, reads within `reach` pixels.
  void add_patch(int x, int y, int reach) {
    const int right = std::min(x + reach, image_.width - 1) / kSide;
    const int bottom = std::min(y + reach, image_.height - 1) / kSide;
    for (int row = std::max(y - reach, 0) / kSide; row <= bottom; ++row) {
      for (int column = std::max(x - reach, 0) / kSide; column <= right; ++column) {
        wanted_[static_cast<std::size_t>(row * columns_ + column)] = 1;
      }
    }
  }

  cv::Size image() const { return image_; }
  int rows() const { return rows_; }  ///< number of rows of tiles
  /// Appends the wanted pixels of a row of tiles, at most `max_length` (a multiple of kSide) side by side, to `parts`.
  void list_parts(int row, int max_length, std::vector<cv::Rect>& parts) const;

 private:
  bool wanted(int row, int column) const { return wanted_[static_cast<std::size_t>(row * columns_ + column)] != 0; }

  cv::Size image_;
  int rows_ = 0;
  int columns_ = 0;
  std::vector<std::uint8_t> wanted_;
};

}  // namespace houghstream
