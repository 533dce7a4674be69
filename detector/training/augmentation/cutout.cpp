#include "detector/training/augmentation/cutout.hpp"

#include <algorithm>
#include <cstring>

namespace houghstream::training {

std::size_t RowSpans::pixels() const {
  std::size_t count = 0;
  for (const cv::Range& row : columns) count += static_cast<std::size_t>(row.size());
  return count;
}

RowSpans spans_of(const cv::Rect& rect) {
  return {rect.y, std::vector<cv::Range>(static_cast<std::size_t>(rect.height), {rect.x, rect.x + rect.width})};
}

bool contains(const RowSpans& spans, const cv::Rect& rect) {
  if (rect.y < spans.top || rect.y + rect.height > spans.bottom()) return false;
  const auto first = spans.columns.begin() + (rect.y - spans.top);
  return std::all_of(first, first + rect.height,
                     [&](const cv::Range& row) { return row.start <= rect.x && rect.x + rect.width <= row.end; });
}

Cutout::Cutout(RowSpans kept, int pixel_stride) : kept_(std::move(kept)), pixel_stride_(pixel_stride) {
  row_offsets_.reserve(kept_.columns.size());
  std::int32_t end = 0;
  for (const cv::Range& row : kept_.columns) {
    row_offsets_.push_back(end - row.start * pixel_stride);
    end += row.size() * pixel_stride;
  }
  data_.reserve(static_cast<std::size_t>(end));  // never cleared, only written
}

void Cutout::copy_row(int y, const std::uint8_t* from) {
  data_.insert(data_.end(), from, from + static_cast<std::ptrdiff_t>(columns_of(y).size()) * pixel_stride_);
}

int test_value(const PixelTest& test, const CutoutPatch& patch) {
  const int second_mask = (test.kind >> 7) - 1;
  const int difference =
      patch.at(test.dx1, test.dy1)[test.plane] - (patch.at(test.dx2, test.dy2)[test.plane] & second_mask);
  const int shift = test.kind & 31;
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(difference) << shift) >> shift;
}

std::int32_t find_leaf(const Forest& forest, int tree, const CutoutPatch& patch) {
  std::int32_t at = forest.roots[static_cast<std::size_t>(tree)];
  while (at >= 0) {
    const TreeNode& node = forest.nodes[static_cast<std::size_t>(at)];
    at = test_value(node.test, patch) >= node.test.threshold ? node.right : node.left;
  }
  return -1 - at;
}

}  // namespace houghstream::training
