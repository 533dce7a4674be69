#include "tools/log/foreign_frames.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "pipeline/checks.hpp"
#include "tests/tools/log/recordings.hpp"

namespace houghstream {
namespace {

template <typename Message>
images_t convert(images_t (*conversion)(ByteView), const Message& message) {
  const std::vector<std::uint8_t> bytes = encode_message(message);
  return conversion({bytes.data(), bytes.size()});
}

void expect_depth(const images_t& message, const RgbdFrame& frame) {
  EXPECT_EQ(message.utime, frame.utime);
  EXPECT_EQ(cv::norm(images_from_message(message).depth_mm, depth_to_millimetres(frame.depth), cv::NORM_INF), 0.0);
}

void expect_colour(const images_t& message, const RgbdFrame& frame) {
  EXPECT_EQ(cv::norm(images_from_message(message).colour, frame.colour, cv::NORM_INF), 0.0);
}

/// Cut anywhere, a message is refused, not read beyond its end.
template <typename Message>
void expect_cuts_refused(images_t (*conversion)(ByteView), const Message& message) {
  const std::vector<std::uint8_t> bytes = encode_message(message);
  for (std::size_t size = 0; size < bytes.size(); size += size < 100 ? 1 : 97) {
    EXPECT_THROW(conversion({bytes.data(), size}), InputError) << size;
  }
}

TEST(KinectFrame, RawImagesAreUnderstood) {
  const RgbdFrame frame = numbered_frame(3);
  const images_t message = convert(images_from_kinect, kinect_message(frame, false));
  expect_depth(message, frame);
  expect_colour(message, frame);
}

TEST(KinectFrame, CompressedImagesStayAsTheyAre) {
  const RgbdFrame frame = numbered_frame(3);
  const kinect_frame_msg_t kinect = kinect_message(frame, true);
  const images_t message = convert(images_from_kinect, kinect);
  expect_depth(message, frame);
  EXPECT_EQ(message.images[0].data, kinect.image.image_data);
  EXPECT_EQ(message.images[1].data, kinect.depth.depth_data);
}

TEST(KinectFrame, WhatCannotBeMillimetresIsRefused) {
  kinect_frame_msg_t message = kinect_message(numbered_frame(0), false);
  expect_cuts_refused(images_from_kinect, message);
  message.depth.depth_data_format = kinect_depth_msg_t::DEPTH_11BIT;
  EXPECT_THROW(convert(images_from_kinect, message), InputError);
  message = kinect_message(numbered_frame(0), false);
  message.image.image_data_format = kinect_image_msg_t::VIDEO_BAYER;
  EXPECT_THROW(convert(images_from_kinect, message), InputError);
  EXPECT_THROW(convert(images_from_kinect, drake_message(numbered_frame(0))), InputError);
}

TEST(DrakeFrame, MetresBecomeMillimetres) {
  const RgbdFrame frame = numbered_frame(3);
  const images_t message = convert(images_from_drake, drake_message(frame));
  expect_depth(message, frame);
  expect_colour(message, frame);
}

TEST(DrakeFrame, ZlibAndPngAreUnpacked) {
  const RgbdFrame frame = numbered_frame(3);
  const cv::Mat depth_mm = depth_to_millimetres(frame.depth);
  drake_image_array_t drake = drake_message(frame);
  drake.images[2] = drake_image(depth_mm, drake_image_t::PIXEL_FORMAT_DEPTH, drake_image_t::CHANNEL_TYPE_UINT16);
  drake.images[2].data = zip_depth(depth_mm, 1);
  drake.images[2].size = static_cast<std::int32_t>(drake.images[2].data.size());
  drake.images[2].compression_method = drake_image_t::COMPRESSION_METHOD_ZLIB;
  cv::imencode(".png", frame.colour, drake.images[1].data);
  drake.images[1].size = static_cast<std::int32_t>(drake.images[1].data.size());
  drake.images[1].compression_method = drake_image_t::COMPRESSION_METHOD_PNG;
  const images_t message = convert(images_from_drake, drake);
  expect_depth(message, frame);
  expect_colour(message, frame);
}

TEST(DrakeFrame, WhatIsNotOneFrameIsRefused) {
  const drake_image_array_t good = drake_message(numbered_frame(0));
  expect_cuts_refused(images_from_drake, good);
  drake_image_array_t message = good;
  message.images.push_back(message.images[1]);
  message.num_images = 4;
  EXPECT_THROW(convert(images_from_drake, message), InputError);
  message = good;
  message.images[2].bigendian = 1;
  EXPECT_THROW(convert(images_from_drake, message), InputError);
  message = good;
  message.images[2].row_stride += 4;
  EXPECT_THROW(convert(images_from_drake, message), InputError);
  message = good;
  message.images[1].width = -1;
  EXPECT_THROW(convert(images_from_drake, message), InputError);
}

// Package, struct name and constants do not enter a fingerprint; these are the ones of bot_core.
TEST(ForeignTypes, BotCoreHasOurFingerprints) {
  EXPECT_EQ(static_cast<std::uint64_t>(images_t::getHash()), 0x20ba4f05e8f5e33aU);
  EXPECT_EQ(static_cast<std::uint64_t>(image_t::getHash()), 0x14739ffe13d5f5f0U);
}

}  // namespace
}  // namespace houghstream
