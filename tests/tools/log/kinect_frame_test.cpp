#include "tests/tools/log/foreign_frames.hpp"

namespace houghstream::log_tools {
namespace {

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
