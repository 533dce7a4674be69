#include "drivers/openni/openni_parts.hpp"

#include <opencv2/imgproc.hpp>

#include "pipeline/base/checks.hpp"
#include "tests/drivers/openni/virtual_camera.hpp"

namespace houghstream::openni {
namespace {

using Sensor = SensorImage::Sensor;

TEST(OpenniParts, SensorsAndModesInThisProjectsWords) {
  EXPECT_EQ(openni_type(Sensor::kDepth), ::openni::SENSOR_DEPTH);
  EXPECT_EQ(openni_type(Sensor::kColour), ::openni::SENSOR_COLOR);
  ::openni::VideoMode mode;
  mode.setResolution(320, 240);
  mode.setFps(25);
  EXPECT_EQ(camera_mode_of(mode), (CameraMode{320, 240, 25}));
}

TEST(OpenniParts, AnErrorNamesWhatWasTriedInOneLine) {
  EXPECT_NO_THROW(check_openni(::openni::STATUS_OK, "opening"));
  const VirtualCamera camera("error", "");
  const OpenniLibrary library;
  ::openni::Device device;
  const ::openni::Status status = device.open("houghstream-virtual://99");
  ASSERT_NE(status, ::openni::STATUS_OK);
  try {
    check_openni(status, "opening");
    FAIL() << "it is an error";
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_EQ(text.rfind("opening: ", 0), 0U) << text;
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    EXPECT_GT(text.size(), std::string("opening: ").size());
  }
}

TEST(OpenniParts, ADeviceTellsItsModesSerialNumberAndImages) {
  const VirtualCamera camera("parts", "serial AA01\nsize 640x480\nsize 320x240\nrate_hz 25\n");
  const OpenniLibrary library;
  ::openni::Device device;
  ASSERT_EQ(device.open("houghstream-virtual://1"), ::openni::STATUS_OK);
  EXPECT_EQ(serial_of(device), "AA01");
  EXPECT_EQ(common_modes(device), (std::vector<CameraMode>{{640, 480, 25}, {320, 240, 25}}));
  EXPECT_FALSE(find_mode(device, Sensor::kDepth, {320, 240, 30}).has_value());
  for (const Sensor sensor : {Sensor::kDepth, Sensor::kColour}) {
    const auto mode = find_mode(device, sensor, {320, 240, 25});
    ASSERT_TRUE(mode.has_value());
    ::openni::VideoStream stream;
    ASSERT_EQ(stream.create(device, openni_type(sensor)), ::openni::STATUS_OK);
    stream.setVideoMode(*mode);
    stream.setMirroringEnabled(false);
    stream.start();
    const std::optional<SensorImage> image = read_image(stream, sensor);
    ASSERT_TRUE(image.has_value());
    EXPECT_EQ(image->sensor, sensor);
    EXPECT_EQ(image->image.size(), cv::Size(320, 240));
    EXPECT_EQ(image->image.type(), sensor == Sensor::kDepth ? CV_16UC1 : CV_8UC3);
    cv::Mat bgr;
    if (sensor == Sensor::kColour) cv::cvtColor(image->image, bgr, cv::COLOR_RGB2BGR);
    const cv::Point2d disc = sensor == Sensor::kDepth ? disc_in_depth_mm(image->image) : disc_in_colour(bgr);
    EXPECT_GT(disc.x, 0.0) << "RGB and millimetres: the disc is seen";
    stream.stop();
    stream.destroy();
  }
}

}  // namespace
}  // namespace houghstream::openni
