#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"
#include "pipeline/messages/messages.hpp"
#include "pipeline/messages/wire_check.hpp"
#include "tests/expect_says.hpp"
#include "tests/pipeline/test_frame.hpp"
#include "tests/test_files.hpp"

namespace houghstream {
namespace {

images_t good_message() {
  return to_message(make_test_frame(99), WireFormat{}, 3);
}

images_t raw_message() {
  WireFormat raw;
  raw.jpeg = false;
  raw.zip_depth = false;
  return to_message(make_test_frame(99), raw, 3);
}

// Returns the message of a third-party driver, without this project's metadata.
images_t foreign(images_t message) {
  for (image_t& image : message.images) {
    image.metadata.clear();
    image.nmetadata = 0;
  }
  return message;
}

void expect_refused(const images_t& message, const std::string& because) {
  expect_says(error_of([&] { frame_from_message(message, "LEFT", std::nullopt); }), {because, "frame LEFT 99"});
}

TEST(FrameMessage, RawFramesComeBackExactly) {
  const RgbdFrame frame = make_test_frame(99);
  const RgbdFrame back = frame_from_message(raw_message(), "LEFT", std::nullopt);
  EXPECT_EQ(back.id, (FrameId{"LEFT", 99}));
  EXPECT_EQ(cv::norm(back.colour, frame.colour, cv::NORM_INF), 0.0);
  EXPECT_TRUE(same_depth(back.depth, frame.depth));
  EXPECT_EQ(back.camera, frame.camera);
  ASSERT_EQ(back.stages.size(), 1U);
  EXPECT_EQ(back.stages[0].stage, "capture.read");
  EXPECT_EQ(back.stages[0].duration_us, 1200);
}

TEST(FrameMessage, CompressedDepthComesBackExactly) {
  const images_t message = good_message();
  EXPECT_EQ(message.images[0].pixelformat, image_t::PIXEL_FORMAT_MJPEG);
  EXPECT_EQ(message.image_types[1], images_t::DEPTH_MM_ZIPPED);
  const RgbdFrame back = frame_from_message(message, "LEFT", std::nullopt);
  EXPECT_TRUE(same_depth(back.depth, make_test_frame(99).depth));
  EXPECT_EQ(read_sequence_number(message), 3);
}

TEST(FrameMessage, DepthAloneIsReadWithoutTheColours) {
  images_t message = good_message();
  message.images[0].data.assign(message.images[0].data.size(), 0x5A);
  expect_refused(message, "JPEG");
  const RgbdFrame back = depth_frame_from_message(message, "LEFT", std::nullopt);
  const RgbdFrame frame = make_test_frame(99);
  EXPECT_EQ(back.id, (FrameId{"LEFT", 99}));
  EXPECT_TRUE(back.colour.empty());
  EXPECT_TRUE(same_depth(back.depth, frame.depth));
  EXPECT_EQ(back.camera, frame.camera);
  ASSERT_EQ(back.stages.size(), 1U);
  const Camera half{32, 24, 30.0, 30.0, 16.0, 12.0};
  EXPECT_THROW(depth_frame_from_message(foreign(good_message()), "LEFT", half), InputError) << "of another size";
  message.images[1].data.resize(10);
  message.images[1].size = 10;
  EXPECT_THROW(depth_frame_from_message(message, "LEFT", std::nullopt), InputError) << "cut";
}

TEST(FrameMessage, ColourOnTheWireIsRgb) {
  const images_t message = raw_message();
  const auto bgr = make_test_frame(99).colour.at<cv::Vec3b>(0, 5);
  EXPECT_EQ(message.images[0].data[15], bgr[2]);
  EXPECT_EQ(message.images[0].data[17], bgr[0]);
}

TEST(FrameMessage, AForeignFrameNeedsTheCameraOption) {
  const images_t message = foreign(good_message());
  expect_refused(message, "--camera");
  const Camera camera = make_test_frame(99).camera;
  EXPECT_EQ(frame_from_message(message, "LEFT", camera).camera, camera);
  EXPECT_FALSE(read_sequence_number(message).has_value());
}

TEST(FrameMessage, ACameraOfAnotherSizeIsRefused) {
  const Camera vga{640, 480, 525, 525, 319.5, 239.5};
  EXPECT_THROW(frame_from_message(foreign(good_message()), "LEFT", vga), InputError);
}

TEST(FrameMessage, BgrGrayAndPaddedRowsAreUnderstood) {
  images_t message = raw_message();
  image_t& colour = message.images[0];
  colour.pixelformat = image_t::PIXEL_FORMAT_BGR;
  const std::uint8_t first = colour.data[0];
  EXPECT_EQ(frame_from_message(message, "LEFT", std::nullopt).colour.at<cv::Vec3b>(0, 0)[0], first);

  colour.pixelformat = image_t::PIXEL_FORMAT_GRAY;
  colour.row_stride = 64 + 7;
  colour.data.assign(static_cast<std::size_t>(colour.row_stride) * 48, 17);
  colour.data[static_cast<std::size_t>(colour.row_stride)] = 200;
  colour.size = static_cast<std::int32_t>(colour.data.size());
  const cv::Mat grey = frame_from_message(message, "LEFT", std::nullopt).colour;
  EXPECT_EQ(grey.at<cv::Vec3b>(1, 0), cv::Vec3b(200, 200, 200));
  EXPECT_EQ(grey.at<cv::Vec3b>(1, 1), cv::Vec3b(17, 17, 17));
}

TEST(FrameMessage, AFourthChannelIsPassedOver) {
  images_t message = raw_message();
  image_t& colour = message.images[0];
  colour.row_stride = 4 * 64;
  colour.data.assign(static_cast<std::size_t>(colour.row_stride) * 48, 0);
  colour.size = static_cast<std::int32_t>(colour.data.size());
  colour.data[0] = 200;
  colour.data[3] = 17;
  colour.pixelformat = image_t::PIXEL_FORMAT_RGBA;
  EXPECT_EQ(frame_from_message(message, "LEFT", std::nullopt).colour.at<cv::Vec3b>(0, 0), cv::Vec3b(0, 0, 200));
  colour.pixelformat = image_t::PIXEL_FORMAT_BGRA;
  EXPECT_EQ(frame_from_message(message, "LEFT", std::nullopt).colour.at<cv::Vec3b>(0, 0), cv::Vec3b(200, 0, 0));
}

TEST(FrameMessage, ImagesAreReadWithoutACamera) {
  const images_t message = foreign(raw_message());
  const FrameImages images = images_from_message(message);
  EXPECT_EQ(cv::norm(images.colour, make_test_frame(99).colour, cv::NORM_INF), 0.0);
  EXPECT_EQ(cv::norm(images.depth_mm, depth_to_millimetres(make_test_frame(99).depth), cv::NORM_INF), 0.0);
  EXPECT_FALSE(read_camera_metadata(message).has_value());
}

TEST(FrameMessage, CameraAndCounterCanBeAdded) {
  images_t message = foreign(raw_message());
  const Camera camera = make_test_frame(99).camera;
  add_camera(message, camera);
  add_sequence(message, 7);
  EXPECT_EQ(frame_from_message(message, "LEFT", std::nullopt).camera, camera);
  EXPECT_EQ(read_sequence_number(message), 7);
  images_t empty{};
  EXPECT_THROW(add_camera(empty, camera), InputError);
}

TEST(FrameMessage, ImagesAreFoundByTypeNotByPosition) {
  images_t message = foreign(raw_message());
  std::swap(message.images[0], message.images[1]);
  std::swap(message.image_types[0], message.image_types[1]);
  const Camera camera = make_test_frame(99).camera;
  EXPECT_TRUE(same_depth(frame_from_message(message, "LEFT", camera).depth, make_test_frame(99).depth));
}

TEST(FrameMessage, MissingImagesAreRefused) {
  images_t message = good_message();
  message.image_types[1] = images_t::DISPARITY;
  expect_refused(message, "DEPTH_MM");
  message = good_message();
  message.image_types[0] = images_t::RIGHT;
  expect_refused(message, "LEFT");
}

TEST(FrameMessage, SizesThatDisagreeAreRefused) {
  images_t message = good_message();
  message.images[1].width = 63;
  expect_refused(message, "registered");
  message = good_message();
  message.images[0].height = message.images[1].height = 40;
  expect_refused(message, "JPEG of 64x48");
  message = raw_message();
  message.images[0].data.resize(100);
  message.images[0].size = 100;
  expect_refused(message, "raw image of 100 bytes");
  message = raw_message();
  message.images[1].row_stride = 2;
  expect_refused(message, "row stride");
}

TEST(FrameMessage, AbsurdSizesAreRefused) {
  for (const std::int32_t size : {0, -1, -2147483647 - 1, 2147483647, 100000}) {
    for (images_t message : {good_message(), raw_message()}) {
      message.images[0].width = message.images[1].width = size;
      message.images[0].height = message.images[1].height = size;
      EXPECT_THROW(frame_from_message(message, "LEFT", std::nullopt), InputError) << size;
    }
  }
}

TEST(FrameMessage, DamagedImagesAndMetadataAreRefused) {
  images_t message = good_message();
  message.images[0].data.resize(message.images[0].data.size() / 2);
  expect_refused(message, "JPEG");
  message = good_message();
  message.images[1].data.resize(message.images[1].data.size() / 2);
  expect_refused(message, "zlib");
  message = good_message();
  message.images[0].pixelformat = 12345;
  expect_refused(message, "12345");
  message = good_message();
  message.images[0].metadata[0].value.resize(10);
  expect_refused(message, "camera_t");
  message = good_message();
  message.images[0].metadata[1].value.pop_back();
  expect_refused(message, "stages");
}

TEST(FrameMessage, AFrameThatIsNoneIsNotSent) {
  RgbdFrame frame = make_test_frame(1);
  frame.depth = frame.depth(cv::Rect(0, 0, 10, 10)).clone();
  EXPECT_THROW(to_message(frame, WireFormat{}, 0), InputError);
}

}  // namespace
}  // namespace houghstream
