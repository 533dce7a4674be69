#include "detector/features/feature_tiles.hpp"

namespace houghstream {
namespace {

int tiles_along(int pixels) {
  return (pixels + FeatureTiles::kSide - 1) / FeatureTiles::kSide;
}

}  // namespace

void FeatureTiles::clear(cv::Size image) {
  image_ = image;
  rows_ = tiles_along(image.height);
  columns_ = tiles_along(image.width);
  wanted_.assign(static_cast<std::size_t>(rows_ * columns_), 0);
}

void FeatureTiles::want_all(cv::Size image) {
  clear(image);
  std::fill(wanted_.begin(), wanted_.end(), std::uint8_t{1});
}

void FeatureTiles::list_parts(int row, int max_length, std::vector<cv::Rect>& parts) const {
  const int top = row * kSide;
  const int height = std::min(kSide, image_.height - top);
  for (int column = 0; column < columns_;) {
    int end = column;
    while (end < columns_ && (end - column) * kSide < max_length && wanted(row, end)) ++end;
    if (end > column) {
      const int left = column * kSide;
      parts.emplace_back(left, top, std::min(end * kSide, image_.width) - left, height);
    }
    column = std::max(end, column + 1);
  }
}

}  // namespace houghstream
