#pragma once

#include <cstddef>
#include <cstdint>
#include <opencv2/core/types.hpp>
#include <vector>

#include "detector/features/feature_image.hpp"
#include "detector/features/image_buffer.hpp"
#include "detector/forest/forest.hpp"
#include "detector/forest/pixel_test.hpp"

namespace houghstream::training {

/// A part of each of some rows of pixels that follow one another. None is empty.
struct RowSpans {
  int top = 0;                     ///< first row
  std::vector<cv::Range> columns;  ///< by row

  int bottom() const { return top + static_cast<int>(columns.size()); }
  std::size_t pixels() const;
};

RowSpans spans_of(const cv::Rect& rect);

/// Returns whether all of a rectangle lies in these rows.
bool contains(const RowSpans& spans, const cv::Rect& rect);

/// A patch as PatchView, whose rows may begin anywhere.
struct CutoutPatch {
  const std::uint8_t* column = nullptr;       ///< pixel of the patch's column in a row whose offset is 0
  const std::int32_t* row_offsets = nullptr;  ///< bytes, by row; the first is the patch's own, others lie before it
  std::int32_t scale = 0;                     ///< see PatchView::scale
  int pixel_stride = 0;                       ///< bytes

  /// Returns the values of the pixel (dx, dy) steps away: that of patch_offset.
  const std::uint8_t* at(int dx, int dy) const {
    const int x_px = (dx * scale + 128) >> 8;
    const int y_px = (dy * scale + 128) >> 8;
    return column + row_offsets[y_px] + x_px * pixel_stride;
  }
};

/// The pixels of a FeatureImage that some patches read, and few others: training sets would not fit into memory with
/// all of them.
class Cutout {
 public:
  Cutout() = default;
  /// Copies these pixels, which `from` must hold: a FeatureImage or a Cutout.
  template <typename Image>
  Cutout(const Image& from, RowSpans kept) : Cutout(std::move(kept), from.pixel_stride()) {
    for (int y = kept_.top; y < kept_.bottom(); ++y) copy_row(y, from.at(columns_of(y).start, y));
  }

  int pixel_stride() const { return pixel_stride_; }
  const RowSpans& held() const { return kept_; }
  std::size_t bytes() const { return data_.size(); }

  /// Returns the values of pixel (x,y), which must be one of held().
  const std::uint8_t* at(int x, int y) const { return data_.data() + offset(x, y); }
  /// Returns a patch of which held() has every pixel.
  CutoutPatch patch(int x, int y, std::int32_t scale) const {
    return {data_.data() + x * pixel_stride_, row_offsets_.data() + (y - kept_.top), scale, pixel_stride_};
  }

 private:
  Cutout(RowSpans kept, int pixel_stride);
  const cv::Range& columns_of(int y) const { return kept_.columns[static_cast<std::size_t>(y - kept_.top)]; }
  std::ptrdiff_t offset(int x, int y) const {
    return row_offsets_[static_cast<std::size_t>(y - kept_.top)] + static_cast<std::ptrdiff_t>(x) * pixel_stride_;
  }
  void copy_row(int y, const std::uint8_t* from);

  RowSpans kept_;
  int pixel_stride_ = 0;
  std::vector<std::int32_t> row_offsets_;  ///< bytes from the data to where the row's pixel 0 would be
  LineBytes data_;
};

/// Returns the value of a test, as for a PatchView.
int test_value(const PixelTest& test, const CutoutPatch& patch);

/// Returns the leaf that a patch reaches, as for a PatchView.
std::int32_t find_leaf(const Forest& forest, int tree, const CutoutPatch& patch);

}  // namespace houghstream::training
