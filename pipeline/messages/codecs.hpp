#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "pipeline/messages/wire_reader.hpp"

namespace houghstream {

/// Images with more pixels than this (4K) are refused before memory is allocated.
constexpr std::int64_t kMaxPixels = 3840LL * 2160LL;

/// Throws InputError unless both sizes are positive and their product is at most kMaxPixels.
void check_image_size(std::int64_t width, std::int64_t height);

/// Encodes CV_8UC3 BGR as JPEG (4:2:0), `quality` 1 to 100.
std::vector<std::uint8_t> encode_jpeg(const cv::Mat& bgr, int quality);

/// Decodes JPEG to CV_8UC3 BGR of exactly this size. Throws InputError when it is damaged, cut or of another size, or
/// when it has more than kMaxScans scans: each one passes over the whole image, and may take a few bytes only.
constexpr int kMaxScans = 16;
cv::Mat decode_jpeg(ByteView jpeg, int width, int height);

/// Packs CV_16UC1 into a zlib stream, `level` 1 to 9.
std::vector<std::uint8_t> zip_depth(const cv::Mat& depth_mm, int level);

/// Unpacks a zlib stream to exactly `raw_size` bytes. Throws InputError when it is damaged, cut or of another size;
/// never unpacks more than that.
std::vector<std::uint8_t> unzip(ByteView zipped, std::size_t raw_size);

/// Unpacks a zlib stream to CV_16UC1 of exactly this size. Throws InputError as unzip() does.
cv::Mat unzip_depth(ByteView zipped, int width, int height);

}  // namespace houghstream
