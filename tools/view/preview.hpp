#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace houghstream::view {

/// A message of this size passes through the receive buffer that an untuned Linux gives to programs that request none,
/// Java's among them, with space for other messages on the bus.
constexpr std::size_t kMaxPreviewBytes = 90'000;

/// Holds an image as JPEG of at most so many bytes.
struct PreviewImage {
  int width = 0;   ///< pixels
  int height = 0;  ///< pixels
  std::vector<std::uint8_t> jpeg;
};

/// Encodes the image (CV_8UC3, BGR) at the best quality, and if need be at a smaller size, that fits `max_bytes`.
/// Throws InputError where even a few pixels do not fit.
PreviewImage encode_preview(const cv::Mat& image, std::size_t max_bytes = kMaxPreviewBytes);

}  // namespace houghstream::view
