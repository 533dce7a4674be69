#include "pipeline/base/image_decoding.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <vector>

namespace houghstream {
namespace {

/// Returns a PNG of a few bytes whose header claims this width.
std::vector<std::uint8_t> png_of_width(std::uint8_t high_byte) {
  std::vector<std::uint8_t> png;
  cv::imencode(".png", cv::Mat(3, 4, CV_8UC1, cv::Scalar(7)), png);
  png[17] = high_byte;  // second of the four big-endian bytes from 16 on
  return png;
}

TEST(ImageDecoding, WhatCannotBeDecodedIsEmpty) {
  const std::vector<std::uint8_t> good = png_of_width(0);
  EXPECT_EQ(decode_image(good.data(), good.size(), cv::IMREAD_UNCHANGED).size(), cv::Size(4, 3));
  EXPECT_TRUE(decode_image(nullptr, 0, cv::IMREAD_UNCHANGED).empty());
  EXPECT_TRUE(decode_image(good.data(), 20, cv::IMREAD_UNCHANGED).empty());
  const std::vector<std::uint8_t> huge = png_of_width(0xFF);
  EXPECT_TRUE(decode_image(huge.data(), huge.size(), cv::IMREAD_UNCHANGED).empty());
}

// 8192x8192 pixels of one value are a PNG of 65 kB; OpenCV itself draws the line at a thousand million.
TEST(ImageDecoding, MorePixelsThanAnyCameraHasAreNotDecoded) {
  std::vector<std::uint8_t> png;
  cv::imencode(".png", cv::Mat(8192, 8192, CV_8UC1, cv::Scalar(7)), png);
  EXPECT_TRUE(decode_image(png.data(), png.size(), cv::IMREAD_UNCHANGED).empty());
  std::vector<std::uint8_t> jpeg;
  cv::imencode(".jpg", cv::Mat(16, 16, CV_8UC3, cv::Scalar::all(90)), jpeg);
  EXPECT_EQ(decode_image(jpeg.data(), jpeg.size(), cv::IMREAD_COLOR).size(), cv::Size(16, 16));
  const std::vector<std::uint8_t> scan = {0xFF, 0xDA, 0, 8, 1, 1, 0, 1, 63, 0, 0x2B};
  for (int i = 0; i < 70; ++i) jpeg.insert(jpeg.end() - 2, scan.begin(), scan.end());
  EXPECT_TRUE(decode_image(jpeg.data(), jpeg.size(), cv::IMREAD_COLOR).empty());
}

TEST(ImageDecoding, SoItIsOfFiles) {
  const auto file = std::filesystem::temp_directory_path() / ("image_decoding_test." + std::to_string(getpid()));
  const std::vector<std::uint8_t> huge = png_of_width(0xFF);
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(huge.data()), static_cast<std::streamsize>(huge.size()));
  EXPECT_TRUE(decode_image_file(file, cv::IMREAD_COLOR).empty());
  std::filesystem::remove(file);
  EXPECT_TRUE(decode_image_file(file, cv::IMREAD_COLOR).empty());
}

TEST(ImageDecoding, APngThatIsCutIsRefusedWithoutAWordOfTheLibrary) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("image_decoding_cut_" + std::to_string(getpid()) + ".png");
  cv::Mat noise(100, 100, CV_8UC3);
  cv::randu(noise, 0, 256);
  cv::imwrite(file.string(), noise);
  EXPECT_EQ(decode_image_file(file, cv::IMREAD_COLOR).rows, 100);
  std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
  testing::internal::CaptureStderr();
  EXPECT_TRUE(decode_image_file(file, cv::IMREAD_COLOR).empty());
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace houghstream
