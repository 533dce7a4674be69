#include "drivers/ros_bag/bag_source.hpp"

#include <gtest/gtest.h>

#include "drivers/datasets/open_frame_source.hpp"
#include "pipeline/base/log_line.hpp"
#include "tests/drivers/ros_bag/test_bag.hpp"
#include "tests/expect_says.hpp"
#include "tests/pipeline/test_frame.hpp"
#include "tests/test_files.hpp"

namespace houghstream::ros_bag {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kStart = 1'600'000'000'000'000;
constexpr std::int64_t kPeriod = 100'000;
const char* const kDepth = "/camera/depth_registered/image_raw";
const char* const kColour = "/camera/rgb/image_color";
const char* const kInfo = "/camera/rgb/camera_info";

/// Says how a bag of one camera is written.
struct Take {
  std::string compression = "none";
  int frames = 5;
  std::int64_t colour_late_us = 2000;  ///< stamps of colour behind those of depth
  std::string depth_topic = kDepth;
  std::string colour_topic = kColour;
  std::string info_topic = kInfo;  ///< "" = none
  std::string depth_frame = "camera_rgb_optical_frame";
  int without_colour = -1;  ///< number of a frame
};

RgbdFrame frame_number(int i) {
  RgbdFrame frame = make_test_frame(kStart + i * kPeriod);
  frame.depth.at<float>(1, 1) = static_cast<float>(700 + i) * 1e-3F;
  frame.colour.at<cv::Vec3b>(2, 2) = {static_cast<std::uint8_t>(i), 1, 2};
  return frame;
}

void add_take(TestBag& bag, const Take& take) {
  for (int i = 0; i < take.frames; ++i) {
    const RgbdFrame frame = frame_number(i);
    const std::int64_t stamp = frame.id.utime;
    const std::int64_t received = stamp + 250'000;  // later than the next images were taken
    if (!take.info_topic.empty())
      bag.add(take.info_topic, kCameraInfoType, camera_info_bytes({stamp, "camera_rgb_optical_frame"}, frame.camera),
              received);
    if (i != take.without_colour)
      bag.add(take.colour_topic, kImageType,
              image_bytes({stamp + take.colour_late_us, "camera_rgb_optical_frame"}, frame.colour, "bgr8"),
              received + 1);
    bag.add(take.depth_topic, kImageType,
            image_bytes({stamp, take.depth_frame}, depth_to_millimetres(frame.depth), "16UC1", 2), received + 2);
    if (i % 2 == 1) bag.end_chunk();
  }
}

std::string save(TestBag bag, const std::string& name = "take") {
  const fs::path file = fresh_folder("bag_source_" + name) / "take.bag";
  bag.save(file.string());
  return file.string();
}

std::string save(const Take& take, const std::string& name = "take") {
  TestBag bag(take.compression);
  add_take(bag, take);
  return save(std::move(bag), name);
}

std::string refusal(const std::string& value) {
  return error_of([&] {
    const auto source = open_frame_source("bag:" + value);
    while (source->next()) continue;
  });
}

/// Returns what is logged while a bag is read to its end.
std::string log_of(const std::string& value) {
  testing::internal::CaptureStderr();
  start_log("test", LogLevel::kInfo);
  {
    const auto source = open_frame_source("bag:" + value);
    while (source->next()) continue;
  }
  return testing::internal::GetCapturedStderr();
}

void expect_frames(const std::string& value, const std::vector<int>& numbers) {
  const auto source = open_frame_source("bag:" + value);
  EXPECT_NEAR(source->rate_hz(), 10.0, 1e-6);
  for (const int number : numbers) {
    const std::optional<RgbdFrame> frame = source->next();
    ASSERT_TRUE(frame.has_value()) << number;
    const RgbdFrame expected = frame_number(number);
    EXPECT_EQ(frame->id.utime, expected.id.utime);
    EXPECT_EQ(frame->camera, expected.camera);
    EXPECT_TRUE(same_depth(frame->depth, expected.depth)) << number;
    EXPECT_EQ(cv::norm(frame->colour, expected.colour, cv::NORM_INF), 0.0) << number;
  }
  EXPECT_FALSE(source->next().has_value());
  EXPECT_FALSE(source->next().has_value());
}

TEST(BagSource, FramesComeBackBitByBitOfEachCompression) {
  for (const std::string compression : {"none", "bz2", "lz4"}) {
    Take take;
    take.compression = compression;
    expect_frames(save(take), {0, 1, 2, 3, 4});
  }
}

TEST(BagSource, TopicsAreFoundAmongOthers) {
  TestBag bag;
  const cv::Mat grey(48, 64, CV_8UC1, cv::Scalar(7));
  const cv::Mat infrared(48, 64, CV_16UC1, cv::Scalar(7));
  bag.add("/tf", "tf/tfMessage", {1, 2, 3}, kStart);
  bag.add("/camera/ir/image", kImageType, image_bytes({kStart, "camera_ir"}, infrared, "mono16"), kStart);
  bag.add("/camera/depth/image_raw", kImageType, image_bytes({kStart, "camera_depth"}, infrared, "16UC1"), kStart);
  bag.add("/camera/rgb/image_raw", kImageType, image_bytes({kStart, "camera_rgb"}, grey, "bayer_grbg8"), kStart);
  bag.add("/camera/rgb/image_mono", kImageType, image_bytes({kStart, "camera_rgb"}, grey, "mono8"), kStart);
  bag.add("/camera/rgb/image_color/compressed", kCompressedImageType,
          compressed_image_bytes({kStart, "camera_rgb"}, "bgr8; png compressed ", png_of(grey)), kStart);
  bag.add("/rear/image_color", kImageType,
          image_bytes({kStart, "rear"}, cv::Mat(48, 64, CV_8UC3, cv::Scalar(1)), "bgr8"), kStart);
  add_take(bag, {});
  expect_frames(save(bag), {0, 1, 2, 3, 4});
}

TEST(BagSource, CompressedImagesAreRead) {
  TestBag bag;
  for (int i = 0; i < 3; ++i) {
    const RgbdFrame frame = frame_number(i);
    const MessageHeader header = {frame.id.utime, "camera_rgb_optical_frame"};
    bag.add(kInfo, kCameraInfoType, camera_info_bytes(header, frame.camera), header.stamp_us);
    bag.add(std::string(kColour) + "/compressed", kCompressedImageType,
            compressed_image_bytes(header, "bgr8; png compressed ", png_of(frame.colour)), header.stamp_us);
    Bytes depth(12, 0);
    append_all(depth, png_of(depth_to_millimetres(frame.depth)));
    bag.add(std::string(kDepth) + "/compressedDepth", kCompressedImageType,
            compressed_image_bytes(header, "16UC1; compressedDepth", depth), header.stamp_us);
  }
  expect_frames(save(bag), {0, 1, 2});
}

TEST(BagSource, TheCameraMayLieBesideDepthOrAsRealSenseRecordsIt) {
  Take take;
  take.info_topic = "/camera/depth_registered/camera_info";
  expect_frames(save(take), {0, 1, 2, 3, 4});
  take.depth_topic = "/device_0/sensor_0/Depth_0/image/data";
  take.colour_topic = "/device_0/sensor_1/Color_0/image/data";
  take.info_topic = "/device_0/sensor_1/Color_0/info/camera_info";
  expect_frames(save(take), {0, 1, 2, 3, 4});
}

TEST(BagSource, WithoutACameraItSaysWhereOneIsExpected) {
  Take take;
  take.info_topic = "";
  const std::string file = save(take);
  expect_says(refusal(file), {"take.bag", "no camera_info", kColour, "info=TOPIC", "camera=WIDTHxHEIGHT"});
  expect_frames(file + ",camera=64x48,57.6,57.6,32,24", {0, 1, 2, 3, 4});
  expect_says(refusal(file + ",camera=32x24,57.6,57.6,16,12"), {"take.bag", kDepth, "64x48", "32x24"});
}

TEST(BagSource, SeveralCamerasAreNamedAndOneIsChosen) {
  TestBag bag;
  add_take(bag, {});
  Take second;
  second.depth_topic = "/left/depth_registered/image_raw";
  second.colour_topic = "/left/rgb/image_color";
  second.info_topic = "/left/rgb/camera_info";
  add_take(bag, second);
  const std::string file = save(bag);
  expect_says(refusal(file), {"take.bag", "several depth topics", kDepth, second.depth_topic, "bag:FILE,depth=TOPIC"});
  for (const std::string& topic : {second.depth_topic, std::string(kDepth)}) {
    expect_frames(file + ",depth=" + topic, {0, 1, 2, 3, 4});
    const std::string camera = topic == kDepth ? "/camera/rgb" : "/left/rgb";
    EXPECT_NE(log_of(file + ",depth=" + topic).find("depth of " + topic + ", colour of " + camera), std::string::npos);
  }
  expect_frames(file + ",depth=" + kDepth + ",colour=left/rgb/image_color,info=" + kInfo, {0, 1, 2, 3, 4});
}

TEST(BagSource, BadChoicesAreRefused) {
  const std::string file = save(Take{});
  expect_says(refusal(file + ",depth=/other"), {"take.bag", "no images on topic /other", kDepth, kColour});
  expect_says(refusal(file + ",depth=" + kColour), {"take.bag", kColour, "bgr8", "expected depth"});
  expect_says(refusal(file + ",colour=" + kDepth), {"take.bag", kDepth, "16UC1", "expected colour"});
  expect_says(refusal(file + ",info=/other"), {"take.bag", "no topic /other", "sensor_msgs/CameraInfo"});
  expect_says(refusal(file + ",speed=3"), {"take.bag", "'speed'", "depth=TOPIC"});
  expect_says(refusal(file + ",depth="), {"take.bag", "depth= without a topic"});
  expect_says(refusal(file + ",camera=64x48"), {"64x48", "WIDTHxHEIGHT"});
  expect_says(refusal("/no/such.bag,depth=/x"), {"/no/such.bag", "a ROS bag"});
}

TEST(BagSource, WithoutDepthOrColourItNamesTheImages) {
  for (const bool has_depth : {true, false}) {
    TestBag bag;
    const RgbdFrame frame = frame_number(0);
    const cv::Mat pixels = has_depth ? depth_to_millimetres(frame.depth) : frame.colour;
    bag.add("/image", kImageType, image_bytes({kStart, ""}, pixels, has_depth ? "16UC1" : "bgr8"), kStart);
    expect_says(refusal(save(bag)), {"take.bag", has_depth ? "no colour" : "no depth", "/image"});
  }
  TestBag bag;
  bag.add("/tf", "tf/tfMessage", {1}, kStart);
  expect_says(refusal(save(bag)), {"take.bag", "no depth", "its images: none"});
}

TEST(BagSource, WhatFindsNoPartnerIsCountedAndTold) {
  Take take;
  take.without_colour = 2;
  const std::string file = save(take);
  expect_frames(file, {0, 1, 3, 4});
  EXPECT_NE(log_of(file).find("4 frames; left out: 1 depth and 0 colour images without a partner within 50.0 ms"),
            std::string::npos);
  EXPECT_EQ(log_of(save(Take{})).find("left out"), std::string::npos);
}

TEST(BagSource, ColourOfAnotherFrameIsTakenWhereItIsNearer) {
  Take take;
  take.colour_late_us = 60'000;
  const auto source = open_frame_source("bag:" + save(take));
  for (int number = 1; number < 5; ++number) {
    const std::optional<RgbdFrame> frame = source->next();
    ASSERT_TRUE(frame.has_value());
    EXPECT_EQ(frame->id.utime, frame_number(number).id.utime);
    EXPECT_EQ(cv::norm(frame->colour, frame_number(number - 1).colour, cv::NORM_INF), 0.0);
  }
  EXPECT_FALSE(source->next().has_value());
}

TEST(BagSource, StreamsThatNeverMeetAreRefused) {
  Take take;
  take.colour_late_us = 3'600'000'000;
  expect_says(refusal(save(take)), {"take.bag", "no colour image of", "within 50.0 ms", "5 and 5 images"});
}

TEST(BagSource, StampsThatAreMissingAreRefused) {
  TestBag bag;
  const RgbdFrame frame = frame_number(0);
  bag.add(kInfo, kCameraInfoType, camera_info_bytes({0, ""}, frame.camera), kStart);
  bag.add(kColour, kImageType, image_bytes({0, ""}, frame.colour, "bgr8"), kStart);
  bag.add(kDepth, kImageType, image_bytes({0, ""}, depth_to_millimetres(frame.depth), "16UC1"), kStart);
  expect_says(refusal(save(bag)), {"take.bag", "without a stamp", "time of capture"});
}

TEST(BagSource, DepthOfAnotherFrameIsTakenAsRegisteredAndTold) {
  Take take;
  take.depth_topic = "/camera/depth/image_raw";
  take.depth_frame = "camera_depth_optical_frame";
  const std::string file = save(take);
  expect_frames(file, {0, 1, 2, 3, 4});
  EXPECT_NE(
      log_of(file).find("is in frame 'camera_depth_optical_frame', colour in 'camera_rgb_optical_frame': taken as "
                        "registered"),
      std::string::npos);
  EXPECT_EQ(log_of(save(Take{})).find("taken as"), std::string::npos);
}

TEST(BagSource, AFilesNameMayHoldCommas) {
  const fs::path file = fresh_folder("bag_source_comma") / "take,depth=2,3.bag";
  TestBag bag;
  add_take(bag, {});
  bag.save(file.string());
  expect_frames(file.string(), {0, 1, 2, 3, 4});
  expect_frames(file.string() + ",depth=" + kDepth, {0, 1, 2, 3, 4});
}

}  // namespace
}  // namespace houghstream::ros_bag
