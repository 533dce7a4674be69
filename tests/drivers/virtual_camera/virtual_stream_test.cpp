#include "drivers/virtual_camera/virtual_stream.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "tests/drivers/virtual_camera/taken_images.hpp"

namespace houghstream::virtual_camera {
namespace {

const OniVideoMode kLargeMode{ONI_PIXEL_FORMAT_DEPTH_1_MM, 64, 48, 30};
const OniVideoMode kSmallMode{ONI_PIXEL_FORMAT_DEPTH_1_MM, 32, 24, 30};

/// A stream of a device that has none itself.
class VirtualStreamTest : public ::testing::Test {
 protected:
  template <typename T>
  OniStatus set(int property, const T& value) {
    return stream.setProperty(property, &value, sizeof(value));
  }
  template <typename T>
  T get(int property) {
    T value{};
    int size = sizeof(value);
    EXPECT_EQ(stream.getProperty(property, &value, &size), ONI_STATUS_OK) << property;
    return value;
  }

  const Camera camera{64, 48, 50.0, 60.0, 31.5, 23.5};
  const ImagesBySize camera_images{{{64, 48}, make_test_pattern(camera)}};
  const ScriptWatch script{std::filesystem::path()};
  VirtualDevice device{script, camera_images, "TEST"};
  VirtualStream stream{device,
                       {ONI_SENSOR_DEPTH, {kLargeMode, kSmallMode}, {camera, {32, 24, 40.0, 40.0, 15.5, 11.5}}}};
  TakenImages taken{stream};
  const cv::Mat image = camera_images.at({64, 48}).images[3].depth_mm;
};

TEST_F(VirtualStreamTest, ImagesAreSentWhileItRunsMirroredUnlessAskedOtherwise) {
  stream.send(image, 1, 100);
  stream.start();
  stream.send(image, 2, 200);
  EXPECT_EQ(set(ONI_STREAM_PROPERTY_MIRRORING, OniBool{FALSE}), ONI_STATUS_OK);
  stream.send(image, 3, 300);
  stream.stop();
  stream.send(image, 4, 400);
  const auto images = taken.wait(2);
  ASSERT_EQ(images.size(), 2U);
  cv::Mat mirrored;
  cv::flip(image, mirrored, 1);
  ASSERT_GT(cv::norm(mirrored, image, cv::NORM_INF), 0.0);
  EXPECT_EQ(cv::norm(images[0].image, mirrored, cv::NORM_INF), 0.0);
  EXPECT_EQ(cv::norm(images[1].image, image, cv::NORM_INF), 0.0);
  EXPECT_EQ(images[1].frame.frameIndex, 3);
  EXPECT_EQ(images[1].frame.timestamp, 300U);
  EXPECT_EQ(images[1].frame.dataSize, 64 * 48 * 2);
  EXPECT_EQ(images[1].frame.stride, 64 * 2);
  EXPECT_EQ(images[1].frame.sensorType, ONI_SENSOR_DEPTH);
}

TEST_F(VirtualStreamTest, OnlyItsModesCanBeSetAndOtherSizesAreNotSent) {
  OniVideoMode unknown = kSmallMode;
  unknown.fps = 60;
  EXPECT_EQ(set(ONI_STREAM_PROPERTY_VIDEO_MODE, unknown), ONI_STATUS_BAD_PARAMETER);
  EXPECT_EQ(set(ONI_STREAM_PROPERTY_VIDEO_MODE, 7), ONI_STATUS_BAD_PARAMETER);
  EXPECT_EQ(stream.mode().resolutionX, 64);
  EXPECT_EQ(set(ONI_STREAM_PROPERTY_VIDEO_MODE, kSmallMode), ONI_STATUS_OK);
  EXPECT_EQ(get<OniVideoMode>(ONI_STREAM_PROPERTY_VIDEO_MODE).resolutionX, 32);
  EXPECT_EQ(get<int>(ONI_STREAM_PROPERTY_STRIDE), 64);
  stream.start();
  stream.send(image, 1, 100);
  stream.send(cv::Mat(24, 32, CV_16UC1, cv::Scalar(5)), 2, 200);
  const auto images = taken.wait(1);
  ASSERT_EQ(images.size(), 1U);
  EXPECT_EQ(images[0].frame.frameIndex, 2);
}

TEST_F(VirtualStreamTest, FieldsOfViewAreThoseOfTheModeAndColoursSettingsAreNotDepths) {
  EXPECT_NEAR(get<float>(ONI_STREAM_PROPERTY_HORIZONTAL_FOV), 2.0 * std::atan(32.0 / 50.0), 1e-6);
  EXPECT_NEAR(get<float>(ONI_STREAM_PROPERTY_VERTICAL_FOV), 2.0 * std::atan(24.0 / 60.0), 1e-6);
  EXPECT_EQ(set(ONI_STREAM_PROPERTY_VIDEO_MODE, kSmallMode), ONI_STATUS_OK);
  EXPECT_NEAR(get<float>(ONI_STREAM_PROPERTY_HORIZONTAL_FOV), 2.0 * std::atan(16.0 / 40.0), 1e-6);
  EXPECT_EQ(set(ONI_STREAM_PROPERTY_GAIN, 50), ONI_STATUS_NOT_SUPPORTED);
  EXPECT_FALSE(stream.isPropertySupported(ONI_STREAM_PROPERTY_AUTO_EXPOSURE));
  EXPECT_GT(get<int>(ONI_STREAM_PROPERTY_MAX_VALUE), kPatternWallMm);
  VirtualStream colour(device, {ONI_SENSOR_COLOR, {{ONI_PIXEL_FORMAT_RGB888, 64, 48, 30}}, {camera}});
  const int gain = 50;
  EXPECT_EQ(colour.setProperty(ONI_STREAM_PROPERTY_GAIN, &gain, sizeof(gain)), ONI_STATUS_OK);
  int told = 0;
  int size = sizeof(told);
  EXPECT_EQ(colour.getProperty(ONI_STREAM_PROPERTY_GAIN, &told, &size), ONI_STATUS_OK);
  EXPECT_EQ(told, gain);
  EXPECT_FALSE(colour.isPropertySupported(ONI_STREAM_PROPERTY_MAX_VALUE));
}

}  // namespace
}  // namespace houghstream::virtual_camera
