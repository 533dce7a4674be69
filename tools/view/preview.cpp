#include "tools/view/preview.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "pipeline/base/checks.hpp"
#include "pipeline/messages/codecs.hpp"

namespace houghstream::view {

PreviewImage encode_preview(const cv::Mat& image, std::size_t max_bytes) {
  constexpr double kSmaller = 0.75;
  constexpr int kMinPixels = 16;
  cv::Mat current = image;
  while (true) {
    for (const int quality : {85, 70, 55}) {
      std::vector<std::uint8_t> jpeg = encode_jpeg(current, quality);
      if (jpeg.size() <= max_bytes) return {current.cols, current.rows, std::move(jpeg)};
    }
    if (std::min(current.cols, current.rows) < kMinPixels) break;
    cv::Mat smaller;
    cv::resize(current, smaller, {}, kSmaller, kSmaller, cv::INTER_AREA);
    current = smaller;
  }
  fail("preview of {}x{} pixels does not fit {} bytes", image.cols, image.rows, max_bytes);
}

}  // namespace houghstream::view
