#include "drivers/openni/openni_parts.hpp"

#include <algorithm>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/host_clock.hpp"

namespace houghstream::openni {
namespace {

using Sensor = SensorImage::Sensor;

std::string openni_error() {
  std::string text = ::openni::OpenNI::getExtendedError();
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\t'; }, ' ');
  const std::size_t first = text.find_first_not_of(' ');
  return first == std::string::npos ? "OpenNI2 says no reason"
                                    : text.substr(first, text.find_last_not_of(' ') + 1 - first);
}

bool is_usable(const ::openni::VideoMode& mode, Sensor sensor) {
  const ::openni::PixelFormat format = mode.getPixelFormat();
  if (sensor == Sensor::kColour) return format == ::openni::PIXEL_FORMAT_RGB888;
  return format == ::openni::PIXEL_FORMAT_DEPTH_1_MM || format == ::openni::PIXEL_FORMAT_DEPTH_100_UM;
}

cv::Mat image_of(const ::openni::VideoFrameRef& frame, Sensor sensor) {
  if (frame.getWidth() < 1 || frame.getHeight() < 1) return {};
  const int type = sensor == Sensor::kDepth ? CV_16UC1 : CV_8UC3;
  const std::size_t row = frame.getWidth() * CV_ELEM_SIZE(type);
  const auto stride = static_cast<std::size_t>(frame.getStrideInBytes());
  const auto bytes = static_cast<std::size_t>(frame.getDataSize());
  if (stride < row || bytes < stride * (frame.getHeight() - 1) + row) return {};
  const cv::Mat given(frame.getHeight(), frame.getWidth(), type, const_cast<void*>(frame.getData()), stride);
  if (frame.getVideoMode().getPixelFormat() != ::openni::PIXEL_FORMAT_DEPTH_100_UM) return given.clone();
  cv::Mat millimetres;
  given.convertTo(millimetres, CV_16UC1, 0.1);
  return millimetres;
}

}  // namespace

OpenniLibrary::OpenniLibrary() {
  const ::openni::Status status = ::openni::OpenNI::initialize();
  if (status == ::openni::STATUS_OK) return;
  const std::string reason = openni_error();
  ::openni::OpenNI::shutdown();
  fail(
      "OpenNI2 does not start ({}): it looks for drivers, lib*.so.0, in the folder OpenNI2/Drivers beside "
      "libOpenNI2.so.0",
      reason);
}

OpenniLibrary::~OpenniLibrary() {
  ::openni::OpenNI::shutdown();
}

void check_openni(::openni::Status status, const std::string& what) {
  require(status == ::openni::STATUS_OK, "{}: {}", what, openni_error());
}

::openni::SensorType openni_type(Sensor sensor) {
  return sensor == Sensor::kDepth ? ::openni::SENSOR_DEPTH : ::openni::SENSOR_COLOR;
}

CameraMode camera_mode_of(const ::openni::VideoMode& mode) {
  return {mode.getResolutionX(), mode.getResolutionY(), mode.getFps()};
}

std::optional<::openni::VideoMode> find_mode(::openni::Device& device, Sensor sensor, const CameraMode& wanted) {
  const ::openni::SensorInfo* info = device.getSensorInfo(openni_type(sensor));
  if (info == nullptr) return std::nullopt;
  const auto& modes = info->getSupportedVideoModes();
  for (int i = 0; i < modes.getSize(); ++i) {
    if (is_usable(modes[i], sensor) && camera_mode_of(modes[i]) == wanted) return modes[i];
  }
  return std::nullopt;
}

std::vector<CameraMode> common_modes(::openni::Device& device) {
  std::vector<CameraMode> common;
  const ::openni::SensorInfo* info = device.getSensorInfo(::openni::SENSOR_DEPTH);
  if (info == nullptr) return common;
  const auto& modes = info->getSupportedVideoModes();
  for (int i = 0; i < modes.getSize(); ++i) {
    const CameraMode mode = camera_mode_of(modes[i]);
    const bool known = std::find(common.begin(), common.end(), mode) != common.end();
    const bool both = find_mode(device, Sensor::kDepth, mode) && find_mode(device, Sensor::kColour, mode);
    if (both && !known) common.push_back(mode);
  }
  return common;
}

std::string serial_of(const ::openni::Device& device) {
  char serial[ONI_MAX_STR] = {};
  int size = sizeof(serial);
  const bool told = device.getProperty(ONI_DEVICE_PROPERTY_SERIAL_NUMBER, serial, &size) == ::openni::STATUS_OK;
  serial[ONI_MAX_STR - 1] = '\0';
  return told ? serial : "";
}

std::optional<Sensor> wait_for_image(::openni::VideoStream& depth, ::openni::VideoStream& colour,
                                     std::chrono::milliseconds timeout) {
  ::openni::VideoStream* streams[] = {&depth, &colour};
  int ready = 0;
  const ::openni::Status status =
      ::openni::OpenNI::waitForAnyStream(streams, 2, &ready, static_cast<int>(timeout.count()));
  if (status != ::openni::STATUS_OK) return std::nullopt;
  return ready == 0 ? Sensor::kDepth : Sensor::kColour;
}

std::optional<SensorImage> read_image(::openni::VideoStream& stream, Sensor sensor) {
  ::openni::VideoFrameRef frame;
  if (stream.readFrame(&frame) != ::openni::STATUS_OK || !frame.isValid()) return std::nullopt;
  SensorImage image;
  image.sensor = sensor;
  image.device_us = frame.getTimestamp();
  image.host_us = utime_now();
  image.number = frame.getFrameIndex();
  image.image = image_of(frame, sensor);
  return image;
}

}  // namespace houghstream::openni
