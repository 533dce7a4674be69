#include "tools/view/drawing/tiles.hpp"

#include <algorithm>

#include "pipeline/base/checks.hpp"

namespace houghstream::view {

cv::Mat tiled(const std::vector<cv::Mat>& tiles, int columns) {
  require(!tiles.empty() && columns > 0, "tiles: {} in rows of {}, expected at least one of each", tiles.size(),
          columns);
  constexpr int kGap = 4;
  const int count = static_cast<int>(tiles.size());
  const int rows = (count + columns - 1) / columns;
  const cv::Size step = tiles[0].size() + cv::Size(kGap, kGap);
  cv::Mat image(rows * step.height - kGap, std::min(columns, count) * step.width - kGap, CV_8UC3,
                cv::Scalar(60, 60, 60));
  for (int i = 0; i < count; ++i) {
    const cv::Point corner(i % columns * step.width, i / columns * step.height);
    tiles[static_cast<std::size_t>(i)].copyTo(image(cv::Rect(corner, tiles[0].size())));
  }
  return image;
}

}  // namespace houghstream::view
