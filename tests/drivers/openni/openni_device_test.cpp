#include "drivers/openni/openni_device.hpp"

#include <set>

#include "pipeline/base/checks.hpp"
#include "tests/drivers/openni/virtual_camera.hpp"

namespace houghstream::openni {
namespace {

using Sensor = SensorImage::Sensor;
constexpr std::chrono::seconds kTimeout(20);
const std::string kUri = "houghstream-virtual://1";

TEST(ListCameras, NamesSerialNumbersAndModes) {
  const VirtualCamera camera("list", "serial AA01\nserial AA02\nsize 640x480\nsize 320x240\n");
  const std::vector<CameraDescription> cameras = list_cameras(true);
  ASSERT_EQ(cameras.size(), 2U) << "is LD_LIBRARY_PATH the build folder's virtual_camera?";
  EXPECT_EQ(cameras[1].uri, "houghstream-virtual://2");
  EXPECT_EQ(cameras[1].serial, "AA02");
  EXPECT_EQ(modes_text(cameras[1].modes), "640x480@30, 320x240@30");
  EXPECT_EQ(list_cameras(false)[1].serial, "") << "not opened";
}

TEST(OpenniDevice, GivesImagesOfBothSensorsInTheModeAskedFor) {
  const VirtualCamera camera("device", "size 640x480\nsize 320x240\n");
  CameraOptions options;
  options.mode = {320, 240, 30};
  const auto device = OpenniDevice::open_camera(kUri, options);
  EXPECT_EQ(device->mode(), options.mode);
  EXPECT_FALSE(device->ended());
  std::set<Sensor> sensors;
  for (int i = 0; i < 10; ++i) {
    const std::optional<SensorImage> image = device->wait(kTimeout);
    ASSERT_TRUE(image.has_value());
    EXPECT_EQ(image->image.size(), cv::Size(320, 240));
    EXPECT_GT(image->host_us, 0);
    sensors.insert(image->sensor);
  }
  EXPECT_EQ(sensors.size(), 2U);
}

TEST(OpenniDevice, ItsNominalCameraIsThatOfTheFieldsOfView) {
  const VirtualCamera camera("nominal", "size 640x480\n");
  const Camera nominal = OpenniDevice::open_camera(kUri, CameraOptions{})->nominal_camera();
  EXPECT_EQ(nominal.width, 640);
  EXPECT_NEAR(nominal.fx, nominal.fy, 0.01);
  EXPECT_NEAR(nominal.fx, 525.0, 0.01);
  EXPECT_DOUBLE_EQ(nominal.cx, 319.5);
  EXPECT_DOUBLE_EQ(nominal.cy, 239.5);
}

TEST(OpenniDevice, WhatItLacksIsAnErrorAndAFileMustBeARecording) {
  const VirtualCamera camera("lacks", "can_register no\n");
  EXPECT_THROW(OpenniDevice::open_camera(kUri, CameraOptions{}), InputError);
  CameraOptions assumed;
  assumed.assume_registered = true;
  EXPECT_NO_THROW(OpenniDevice::open_camera(kUri, assumed));
  assumed.mode = {1280, 1024, 30};
  EXPECT_THROW(OpenniDevice::open_camera(kUri, assumed), InputError);
  write_text(camera.folder() / "no.oni", "text");
  EXPECT_THROW(OpenniDevice::open_file((camera.folder() / "no.oni").string()), InputError);
}

}  // namespace
}  // namespace houghstream::openni
