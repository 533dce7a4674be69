#include <opencv2/imgcodecs.hpp>

#include "tests/tools/log/foreign_frames.hpp"

namespace houghstream::log_tools {
namespace {

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

TEST(DrakeFrame, APngThatCannotBeDecodedIsRefusedInOneLine) {
  const RgbdFrame frame = numbered_frame(3);
  drake_image_array_t drake = drake_message(frame);
  drake.images[1].compression_method = drake_image_t::COMPRESSION_METHOD_PNG;
  std::vector<std::uint8_t> png;
  cv::imencode(".png", frame.colour, png);
  std::vector<std::uint8_t> huge = png;
  huge[17] = 0xFF;  // the width's second byte
  const std::vector<std::uint8_t> cut(png.begin(), png.begin() + 40);
  for (const std::vector<std::uint8_t>& data : {std::vector<std::uint8_t>(), huge, cut}) {
    drake.images[1].data = data;
    drake.images[1].size = static_cast<std::int32_t>(data.size());
    EXPECT_THROW(convert(images_from_drake, drake), InputError) << data.size();
  }
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

}  // namespace

}  // namespace houghstream::log_tools
