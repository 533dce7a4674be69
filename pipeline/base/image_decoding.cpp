#include "pipeline/base/image_decoding.hpp"

#include <limits>
#include <opencv2/imgcodecs.hpp>

namespace houghstream {

cv::Mat decode_image(const std::uint8_t* bytes, std::size_t size, int mode) {
  if (size == 0 || size > static_cast<std::size_t>(std::numeric_limits<int>::max())) return {};
  try {
    // The matrix borrows the bytes, and is read only.
    return cv::imdecode(cv::Mat(1, static_cast<int>(size), CV_8UC1, const_cast<std::uint8_t*>(bytes)), mode);
  } catch (const cv::Exception&) {
    return {};
  }
}

cv::Mat decode_image_file(const std::filesystem::path& file, int mode) {
  try {
    return cv::imread(file.string(), mode);
  } catch (const cv::Exception&) {
    return {};
  }
}

}  // namespace houghstream
