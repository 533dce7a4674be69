#include "drivers/ros_bag/bag_images.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <opencv2/imgproc.hpp>

#include "pipeline/base/log_line.hpp"
#include "tests/drivers/ros_bag/test_bag.hpp"
#include "tests/expect_says.hpp"
#include "tests/pipeline/test_frame.hpp"
#include "tests/test_files.hpp"

namespace houghstream::ros_bag {
namespace {

const MessageHeader kHeader = {5'000'123, "camera_rgb_optical_frame"};

ImageMessage parsed(const Bytes& bytes, const std::string& type = kImageType) {
  return parse_image({bytes.data(), bytes.size()}, type, "take.bag, /image");
}

bool is_same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0.0;
}

cv::Mat colour_of(const cv::Mat& pixels, const std::string& encoding, std::size_t padding = 0) {
  const Bytes bytes = image_bytes(kHeader, pixels, encoding, padding);
  return decode_colour(parsed(bytes), "take.bag, /image");
}

cv::Mat depth_of(const Bytes& bytes, const std::string& type = kImageType) {
  return decode_depth(parsed(bytes, type), "take.bag, /depth");
}

TEST(BagImages, HeadersAreParsed) {
  const Bytes bytes = image_bytes(kHeader, make_test_frame(5).colour, "bgr8");
  const MessageHeader header = parse_header({bytes.data(), bytes.size()}, "");
  EXPECT_EQ(header.stamp_us, 5'000'123);
  EXPECT_EQ(header.frame_id, "camera_rgb_optical_frame");
}

TEST(BagImages, ColourOfEachEncodingIsTheSameBitByBit) {
  const cv::Mat bgr = make_test_frame(5).colour;
  EXPECT_TRUE(is_same(colour_of(bgr, "bgr8"), bgr));
  EXPECT_TRUE(is_same(colour_of(bgr, "bgr8", 5), bgr)) << "rows longer than their pixels";
  cv::Mat pixels;
  cv::cvtColor(bgr, pixels, cv::COLOR_BGR2RGB);
  EXPECT_TRUE(is_same(colour_of(pixels, "rgb8", 1), bgr));
  cv::cvtColor(bgr, pixels, cv::COLOR_BGR2RGBA);
  EXPECT_TRUE(is_same(colour_of(pixels, "rgba8"), bgr));
  cv::cvtColor(bgr, pixels, cv::COLOR_BGR2BGRA);
  EXPECT_TRUE(is_same(colour_of(pixels, "bgra8"), bgr));
  cv::extractChannel(bgr, pixels, 0);
  const cv::Mat grey = colour_of(pixels, "mono8");
  for (int channel = 0; channel < 3; ++channel) {
    cv::Mat plane;
    cv::extractChannel(grey, plane, channel);
    EXPECT_TRUE(is_same(plane, pixels));
  }
  const Bytes png = compressed_image_bytes(kHeader, "rgb8; png compressed bgr8", png_of(bgr));
  EXPECT_TRUE(is_same(decode_colour(parsed(png, kCompressedImageType), ""), bgr));
}

TEST(BagImages, DepthOfEachEncodingIsTheSameBitByBit) {
  const cv::Mat depth = make_test_frame(5).depth;
  const cv::Mat mm = depth_to_millimetres(depth);
  for (const std::string encoding : {"16UC1", "mono16"}) {
    EXPECT_TRUE(same_depth(depth_of(image_bytes(kHeader, mm, encoding)), depth));
    EXPECT_TRUE(same_depth(depth_of(image_bytes(kHeader, mm, encoding, 6, true)), depth)) << "big-endian";
  }
  EXPECT_TRUE(same_depth(depth_of(image_bytes(kHeader, depth, "32FC1", 4)), depth));
  EXPECT_TRUE(same_depth(depth_of(image_bytes(kHeader, depth, "32FC1", 0, true)), depth)) << "big-endian";
  Bytes compressed(12, 0);
  append_all(compressed, png_of(mm));
  for (const char* format : {"16UC1; compressedDepth", "16UC1; compressedDepth png"})
    EXPECT_TRUE(same_depth(depth_of(compressed_image_bytes(kHeader, format, compressed), kCompressedImageType), depth));
  EXPECT_TRUE(same_depth(
      depth_of(compressed_image_bytes(kHeader, "16UC1; png compressed ", png_of(mm)), kCompressedImageType), depth));
}

TEST(BagImages, DepthThatIsNoneIsNone) {
  cv::Mat metres(1, 5, CV_32FC1);
  const float infinite = std::numeric_limits<float>::infinity();
  const float values[] = {0.0F, -1.0F, infinite, std::numeric_limits<float>::quiet_NaN(), 1.25F};
  std::copy(std::begin(values), std::end(values), metres.begin<float>());
  const cv::Mat depth = depth_of(image_bytes(kHeader, metres, "32FC1"));
  for (int x = 0; x < 4; ++x) EXPECT_TRUE(std::isnan(depth.at<float>(0, x))) << x;
  EXPECT_EQ(depth.at<float>(0, 4), 1.25F);
}

TEST(BagImages, CompressedMetresAreQuantisedInverses) {
  // 1 / z = (value - b) / a
  const cv::Mat values = (cv::Mat_<std::uint16_t>(1, 3) << 0, 110, 510);
  Bytes compressed;
  append(compressed, std::uint32_t{0});
  append(compressed, 500.0F);
  append(compressed, 10.0F);
  append_all(compressed, png_of(values));
  const cv::Mat depth =
      depth_of(compressed_image_bytes(kHeader, "32FC1; compressedDepth", compressed), kCompressedImageType);
  EXPECT_TRUE(std::isnan(depth.at<float>(0, 0)));
  EXPECT_FLOAT_EQ(depth.at<float>(0, 1), 5.0F);
  EXPECT_FLOAT_EQ(depth.at<float>(0, 2), 1.0F);
}

TEST(BagImages, KindsAreToldByEncoding) {
  const auto kind = [](const char* encoding, bool is_encoded) {
    ImageMessage image;
    image.encoding = encoding;
    image.is_encoded = is_encoded;
    return kind_of_image(image);
  };
  EXPECT_EQ(kind("32FC1", false), ImageKind::kDepth);
  EXPECT_EQ(kind("rgba8", false), ImageKind::kColour);
  EXPECT_EQ(kind("mono8", false), ImageKind::kGrey);
  EXPECT_EQ(kind("bayer_grbg8", false), ImageKind::kOther);
  EXPECT_EQ(kind("bgr8; jpeg compressed bgr8", true), ImageKind::kColour);
  EXPECT_EQ(kind("jpeg", true), ImageKind::kColour);
  EXPECT_EQ(kind("mono8; jpeg compressed ", true), ImageKind::kGrey);
  EXPECT_EQ(kind("16UC1; compressedDepth", true), ImageKind::kDepth);
  EXPECT_EQ(kind("16UC1; jpeg compressed ", true), ImageKind::kOther) << "has lost its depth";
  EXPECT_EQ(kind("h264", true), ImageKind::kOther);
}

TEST(BagImages, BadImagesAreRefused) {
  const cv::Mat mm = depth_to_millimetres(make_test_frame(5).depth);
  const Bytes whole = image_bytes(kHeader, mm, "16UC1");
  for (const std::size_t size : {std::size_t{3}, std::size_t{20}, whole.size() - 1}) {
    const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    expect_says(error_of([&] { depth_of(cut); }), {"take.bag, /image", "cut or damaged"});
  }
  Bytes longer = whole;
  longer.push_back(0);
  expect_says(error_of([&] { depth_of(longer); }), {"take.bag, /image", "1 bytes behind its end"});
  expect_says(error_of([&] { depth_of(image_bytes(kHeader, mm, "32FC1")); }), {"rows of 128 bytes", "at least 256"});
  expect_says(error_of([&] { depth_of(image_bytes(kHeader, mm, "rgb8")); }), {"encoding 'rgb8'", "16UC1"});
  expect_says(error_of([&] { colour_of(mm, "16UC1"); }), {"encoding '16UC1'", "rgb8"});
  expect_says(error_of([&] { colour_of(cv::Mat(), "rgb8"); }), {"0x0 pixels"});
  const Bytes garbage = compressed_image_bytes(kHeader, "jpeg", Bytes(50, 7));
  expect_says(error_of([&] { decode_colour(parsed(garbage, kCompressedImageType), "take.bag, /image"); }),
              {"take.bag, /image", "50 bytes that cannot be decoded"});
  const Bytes nothing = compressed_image_bytes(kHeader, "jpeg", {});
  expect_says(error_of([&] { decode_colour(parsed(nothing, kCompressedImageType), "take.bag, /image"); }),
              {"0 bytes that cannot be decoded"});
  const Bytes rvl = compressed_image_bytes(kHeader, "16UC1; compressedDepth rvl", Bytes(50, 7));
  expect_says(error_of([&] { depth_of(rvl, kCompressedImageType); }), {"rvl", "expected PNG"});
}

const Camera kCamera = {640, 480, 525.0, 526.0, 319.5, 239.5};

Camera camera_with(const std::array<std::uint32_t, 6>& binning_and_roi, bool is_rectified = false,
                   double distortion = 0.0) {
  const Bytes bytes = camera_info_bytes(kHeader, kCamera, distortion, binning_and_roi);
  return camera_of_info(parse_camera_info({bytes.data(), bytes.size()}, "take.bag, /camera_info"), is_rectified,
                        "take.bag, /camera_info");
}

TEST(BagImages, CamerasAreThoseOfTheImages) {
  EXPECT_EQ(camera_with({}), kCamera);
  EXPECT_EQ(camera_with({1, 1, 0, 0, 0, 0}), kCamera);
  EXPECT_EQ(camera_with({2, 2, 0, 0, 0, 0}), kCamera.scaled(0.5));
  EXPECT_EQ(camera_with({0, 0, 200, 150, 200, 300}), kCamera.cropped(200, 150, 300, 200));
  EXPECT_EQ(camera_with({2, 2, 200, 150, 200, 300}), kCamera.cropped(200, 150, 300, 200).scaled(0.5));
  EXPECT_EQ(camera_with({}, true).fx, kCamera.fx + 1.0) << "the projection of rectified images";
  EXPECT_THROW(camera_with({2, 1, 0, 0, 0, 0}), InputError);
}

TEST(BagImages, DistortionThatIsNotCorrectedIsTold) {
  testing::internal::CaptureStderr();
  start_log("test", LogLevel::kInfo);
  camera_with({}, true, 0.1);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << "is rectified";
  testing::internal::CaptureStderr();
  start_log("test", LogLevel::kInfo);
  camera_with({}, false, 0.1);
  EXPECT_NE(testing::internal::GetCapturedStderr().find("take.bag, /camera_info: its distortion is not corrected"),
            std::string::npos);
}

TEST(BagImages, BadCamerasAreRefused) {
  Bytes bytes = camera_info_bytes(kHeader, {640, 480, 0.0, 525.0, 319.5, 239.5});
  expect_says(error_of([&] {
                camera_of_info(parse_camera_info({bytes.data(), bytes.size()}, "info"), false, "take.bag, /info");
              }),
              {"take.bag, /info", "focal lengths 0"});
  bytes.pop_back();
  expect_says(error_of([&] {
                parse_camera_info({bytes.data(), bytes.size()}, "take.bag, /info");
              }),
              {"take.bag, /info", "cut or damaged"});
}

}  // namespace
}  // namespace houghstream::ros_bag
