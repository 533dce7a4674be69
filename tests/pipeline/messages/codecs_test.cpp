#include "pipeline/messages/codecs.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/image_decoding.hpp"
#include "tests/expect_says.hpp"
#include "tests/pipeline/test_frame.hpp"
#include "tests/test_files.hpp"

namespace houghstream {
namespace {

ByteView view(const std::vector<std::uint8_t>& bytes) {
  return {bytes.data(), bytes.size()};
}

TEST(Codecs, DepthComesBackExactly) {
  const cv::Mat depth_mm = depth_to_millimetres(make_test_frame(0).depth);
  for (const int level : {1, 9}) {
    const cv::Mat back = unzip_depth(view(zip_depth(depth_mm, level)), 64, 48);
    EXPECT_EQ(cv::norm(back, depth_mm, cv::NORM_INF), 0.0);
  }
}

TEST(Codecs, DamagedDepthIsRefused) {
  const cv::Mat depth_mm = depth_to_millimetres(make_test_frame(0).depth);
  std::vector<std::uint8_t> zipped = zip_depth(depth_mm, 1);
  EXPECT_THROW(unzip_depth({zipped.data(), zipped.size() / 2}, 64, 48), InputError);
  EXPECT_THROW(unzip_depth({zipped.data(), 0}, 64, 48), InputError);
  zipped[zipped.size() / 2] ^= 0x55U;
  EXPECT_THROW(unzip_depth(view(zipped), 64, 48), InputError);
}

TEST(Codecs, DepthOfAnotherSizeIsRefused) {
  const std::vector<std::uint8_t> zipped = zip_depth(depth_to_millimetres(make_test_frame(0).depth), 1);
  EXPECT_THROW(unzip_depth(view(zipped), 64, 47), InputError);
  EXPECT_THROW(unzip_depth(view(zipped), 64, 49), InputError);
}

TEST(Codecs, ABombIsNotUnpacked) {
  const cv::Mat zeros = cv::Mat::zeros(2000, 2000, CV_16UC1);
  const std::vector<std::uint8_t> bomb = zip_depth(zeros, 9);
  EXPECT_LT(bomb.size(), 10000U);
  EXPECT_THROW(unzip_depth(view(bomb), 64, 48), InputError);
  // A few bytes that claim a large image are refused before memory is allocated.
  EXPECT_THROW(unzip_depth({bomb.data(), 20}, 4096, 4096), InputError);
  EXPECT_THROW(unzip_depth(view(bomb), 100000, 100000), InputError);
}

TEST(Codecs, JpegComesBackNearly) {
  const cv::Mat colour = make_test_frame(0).colour;
  const cv::Mat back = decode_jpeg(view(encode_jpeg(colour, 94)), 64, 48);
  EXPECT_LT(cv::norm(back, colour, cv::NORM_L1) / (64 * 48 * 3), 3.0);
}

TEST(Codecs, DamagedJpegIsRefused) {
  const std::vector<std::uint8_t> jpeg = encode_jpeg(make_test_frame(0).colour, 94);
  for (const double kept : {0.0, 0.1, 0.5, 0.9}) {
    const auto size = static_cast<std::size_t>(kept * static_cast<double>(jpeg.size()));
    EXPECT_THROW(decode_jpeg({jpeg.data(), size}, 64, 48), InputError) << kept;
  }
  const std::vector<std::uint8_t> noise(1000, 0x5A);
  EXPECT_THROW(decode_jpeg(view(noise), 64, 48), InputError);
}

TEST(Codecs, JpegOfAnotherSizeIsRefused) {
  const std::vector<std::uint8_t> jpeg = encode_jpeg(make_test_frame(0).colour, 94);
  EXPECT_THROW(decode_jpeg(view(jpeg), 48, 64), InputError);
  EXPECT_THROW(decode_jpeg(view(jpeg), 0, 48), InputError);
  EXPECT_THROW(decode_jpeg(view(jpeg), -64, -48), InputError);
}

TEST(Codecs, SettingsOutOfRangeAreRefused) {
  const RgbdFrame frame = make_test_frame(0);
  EXPECT_THROW(encode_jpeg(frame.colour, 0), InputError);
  EXPECT_THROW(encode_jpeg(frame.colour, 101), InputError);
  EXPECT_THROW(zip_depth(depth_to_millimetres(frame.depth), 0), InputError);
  EXPECT_THROW(zip_depth(frame.depth, 1), InputError);
}

/// Returns a baseline JPEG with so many empty scans before its end.
std::vector<std::uint8_t> with_scans(int scans) {
  std::vector<std::uint8_t> jpeg = encode_jpeg(cv::Mat(16, 16, CV_8UC3, cv::Scalar::all(90)), 90);
  const std::vector<std::uint8_t> scan = {0xFF, 0xDA, 0, 8, 1, 1, 0, 1, 63, 0, 0x2B};
  for (; scans > 0; --scans) jpeg.insert(jpeg.end() - 2, scan.begin(), scan.end());
  return jpeg;
}

TEST(Codecs, AJpegOfManyScansIsRefusedBeforeItIsDecoded) {
  EXPECT_FALSE(decode_jpeg({with_scans(0).data(), with_scans(0).size()}, 16, 16).empty());
  const std::vector<std::uint8_t> many = with_scans(kMaxScans);
  expect_says(error_of([&] { decode_jpeg({many.data(), many.size()}, 16, 16); }), {"17 scans"});
}

// The marker has no length: a reader that takes the first bytes behind it for one skips scans that the decoder reads.
TEST(Codecs, AMarkerHidesNoScans) {
  std::vector<std::uint8_t> jpeg = with_scans(0);
  const std::vector<std::uint8_t> hidden = {0xFF, 0x01, 0xFF, 0xDA, 0, 8, 1, 1, 0, 1, 63, 0, 0x2B};
  for (int i = 0; i < kMaxScans; ++i) jpeg.insert(jpeg.end() - 2, hidden.begin(), hidden.end());
  EXPECT_EQ(count_jpeg_scans(jpeg.data(), jpeg.size()), kMaxScans + 1);
  EXPECT_THROW(decode_jpeg({jpeg.data(), jpeg.size()}, 16, 16), InputError);
}

}  // namespace
}  // namespace houghstream
