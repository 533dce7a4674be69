#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <opencv2/core.hpp>

namespace houghstream {

/// What OpenCV makes of an encoded image or an image file (`mode`: cv::IMREAD_*); empty where it cannot be decoded.
/// OpenCV itself throws, in words that name no source, where there is nothing to decode or the image is too large.
cv::Mat decode_image(const std::uint8_t* bytes, std::size_t size, int mode);
cv::Mat decode_image_file(const std::filesystem::path& file, int mode);

}  // namespace houghstream
