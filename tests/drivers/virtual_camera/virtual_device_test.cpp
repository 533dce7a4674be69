#include "drivers/virtual_camera/virtual_device.hpp"

#include <gtest/gtest.h>

#include "tests/drivers/virtual_camera/taken_images.hpp"
#include "tests/test_files.hpp"

namespace houghstream::virtual_camera {
namespace {

const Camera kLarge{64, 48, 50.0, 50.0, 31.5, 23.5};
const Camera kSmall{32, 24, 25.0, 25.0, 15.5, 11.5};

/// A device with two sizes that behaves as a script says.
struct ScriptedDevice {
  explicit ScriptedDevice(const std::string& script) : watch(written(script)) {}

  static std::filesystem::path written(const std::string& script) {
    std::filesystem::path file = fresh_folder("virtual_device") / "script";
    write_text(file, script);
    return file;
  }

  const ImagesBySize camera_images{{{64, 48}, make_test_pattern(kLarge)}, {{32, 24}, make_test_pattern(kSmall)}};
  ScriptWatch watch;
  VirtualDevice device{watch, camera_images, "SERIAL7"};
};

/// Returns the first images of a sensor, not mirrored.
std::vector<TakenImages::Image> images_of(VirtualDevice& device, OniSensorType type, std::size_t count) {
  oni::driver::StreamBase* stream = device.createStream(type);
  TakenImages taken(*stream);
  const OniBool mirrored = FALSE;
  stream->setProperty(ONI_STREAM_PROPERTY_MIRRORING, &mirrored, sizeof(mirrored));
  stream->start();
  std::vector<TakenImages::Image> images = taken.wait(count);
  stream->stop();
  device.destroyStream(stream);
  EXPECT_GE(images.size(), count);
  return images;
}

OniStatus set_registration(VirtualDevice& device, OniImageRegistrationMode mode) {
  return device.setProperty(ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION, &mode, sizeof(mode));
}

TEST(VirtualDevice, OffersBothSensorsWithTheLargestSizeFirst) {
  ScriptedDevice scripted("rate_hz 25\n");
  OniSensorInfo* infos = nullptr;
  int count = 0;
  ASSERT_EQ(scripted.device.getSensorInfoList(&infos, &count), ONI_STATUS_OK);
  ASSERT_EQ(count, 2);
  EXPECT_EQ(infos[0].sensorType, ONI_SENSOR_DEPTH);
  EXPECT_EQ(infos[1].sensorType, ONI_SENSOR_COLOR);
  for (int i = 0; i < 2; ++i) {
    ASSERT_EQ(infos[i].numSupportedVideoModes, 2);
    EXPECT_EQ(infos[i].pSupportedVideoModes[0].resolutionX, 64);
    EXPECT_EQ(infos[i].pSupportedVideoModes[1].resolutionX, 32);
    EXPECT_EQ(infos[i].pSupportedVideoModes[0].fps, 25);
  }
  EXPECT_EQ(scripted.device.createStream(ONI_SENSOR_IR), nullptr);
}

TEST(VirtualDevice, TellsItsSerialNumberWhereThereIsRoom) {
  ScriptedDevice scripted("");
  char text[8] = {};
  int size = 7;
  EXPECT_EQ(scripted.device.getProperty(ONI_DEVICE_PROPERTY_SERIAL_NUMBER, text, &size), ONI_STATUS_NOT_SUPPORTED);
  size = 8;
  EXPECT_EQ(scripted.device.getProperty(ONI_DEVICE_PROPERTY_SERIAL_NUMBER, text, &size), ONI_STATUS_OK);
  EXPECT_STREQ(text, "SERIAL7");
}

TEST(VirtualDevice, RegistersAndSynchronisesWhereTheScriptSaysSo) {
  ScriptedDevice able("can_register yes\ncan_sync yes\n");
  EXPECT_EQ(set_registration(able.device, ONI_IMAGE_REGISTRATION_DEPTH_TO_COLOR), ONI_STATUS_OK);
  EXPECT_TRUE(able.device.synchronise());
  ScriptedDevice unable("can_register no\ncan_sync no\n");
  EXPECT_EQ(set_registration(unable.device, ONI_IMAGE_REGISTRATION_DEPTH_TO_COLOR), ONI_STATUS_NOT_SUPPORTED);
  EXPECT_EQ(set_registration(unable.device, ONI_IMAGE_REGISTRATION_OFF), ONI_STATUS_OK);
  EXPECT_FALSE(unable.device.synchronise());
}

TEST(VirtualDevice, UnregisteredDepthLiesBesideItsColour) {
  ScriptedDevice scripted("rate_hz 100\n");
  constexpr int kShift = VirtualDevice::kParallaxPx * 64 / 640;
  const auto& camera_images = scripted.camera_images.at({64, 48}).images;
  const auto beside = images_of(scripted.device, ONI_SENSOR_DEPTH, 1).front();
  const cv::Mat& original =
      camera_images[static_cast<std::size_t>(beside.frame.frameIndex) % camera_images.size()].depth_mm;
  EXPECT_EQ(cv::norm(beside.image.colRange(kShift, 64), original.colRange(0, 64 - kShift), cv::NORM_INF), 0.0);
  EXPECT_EQ(cv::countNonZero(beside.image.colRange(0, kShift)), 0);
  set_registration(scripted.device, ONI_IMAGE_REGISTRATION_DEPTH_TO_COLOR);
  const auto upon = images_of(scripted.device, ONI_SENSOR_DEPTH, 1).front();
  const cv::Mat& same = camera_images[static_cast<std::size_t>(upon.frame.frameIndex) % camera_images.size()].depth_mm;
  EXPECT_EQ(cv::norm(upon.image, same, cv::NORM_INF), 0.0);
}

TEST(VirtualDevice, DropsImagesAndCountsThemAllTheSame) {
  ScriptedDevice scripted("rate_hz 100\ndrop_depth_every 3\n");
  const auto images = images_of(scripted.device, ONI_SENSOR_DEPTH, 6);
  for (std::size_t i = 0; i + 1 < images.size(); ++i) {
    const int number = images[i].frame.frameIndex;
    EXPECT_NE(number % 3, 2);
    EXPECT_EQ(images[i + 1].frame.frameIndex, number % 3 == 1 ? number + 2 : number + 1);
    EXPECT_GT(images[i + 1].frame.timestamp, images[i].frame.timestamp);
  }
}

TEST(VirtualDevice, UnsynchronisedColourHasItsOwnCount) {
  ScriptedDevice scripted("rate_hz 100\n");
  const auto& camera_images = scripted.camera_images.at({64, 48}).images;
  const auto is_ahead_by = [&](int ahead) {
    const auto image = images_of(scripted.device, ONI_SENSOR_COLOR, 1).front();
    const auto number = static_cast<std::size_t>(image.frame.frameIndex - ahead);
    return cv::norm(image.image, camera_images[number % camera_images.size()].colour, cv::NORM_INF) == 0.0;
  };
  EXPECT_TRUE(is_ahead_by(7));
  scripted.device.synchronise();
  images_of(scripted.device, ONI_SENSOR_COLOR, 2);  // one may have been on its way
  EXPECT_TRUE(is_ahead_by(0));
}

}  // namespace
}  // namespace houghstream::virtual_camera
