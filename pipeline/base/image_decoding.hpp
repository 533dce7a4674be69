#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <opencv2/core.hpp>

namespace houghstream {

/// Decodes an encoded image or an image file with OpenCV (`mode`: cv::IMREAD_*); the result is empty where it cannot be
/// decoded, and where a PNG or JPEG states more than 64 million pixels or has more than 64 scans, since a small file
/// may ask for gigabytes or minutes. OpenCV itself throws, in words that name no source, where there is nothing to
/// decode or the image is too large. Of a JPEG in a file it is empty where that is cut too; the frame of a camera may
/// lack its last rows.
cv::Mat decode_image(const std::uint8_t* bytes, std::size_t size, int mode);
cv::Mat decode_image_file(const std::filesystem::path& file, int mode);

/// Scans of a JPEG (ITU-T T.81, annex B), as far as it can be walked through.
int count_jpeg_scans(const std::uint8_t* jpeg, std::size_t size);

}  // namespace houghstream
