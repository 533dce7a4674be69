#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <vector>

namespace houghstream {

/// Reads a colour image, CV_8UC3 BGR. Throws InputError when it is missing or cannot be decoded.
cv::Mat read_colour_image(const std::filesystem::path& file);

/// Reads a depth image as stored, CV_16UC1. Throws InputError when it is missing, cannot be decoded or has another
/// type.
cv::Mat read_depth_image(const std::filesystem::path& file);

/// Reads a mask, CV_8UC1, 0 or 255 (any stored value above 0 is 255). Throws InputError as above.
cv::Mat read_mask_image(const std::filesystem::path& file);

/// Writes PNG, compressed for speed. Throws InputError when the file cannot be written.
void write_png(const cv::Mat& image, const std::filesystem::path& file);

/// Throws InputError unless write_image() knows a format that the file's name ends with.
void require_image_format(const std::filesystem::path& file);

/// Writes an image in the format that its name ends with, with OpenCV's `settings` of that format. Throws InputError.
void write_image(const cv::Mat& image, const std::filesystem::path& file, const std::vector<int>& settings = {});

}  // namespace houghstream
