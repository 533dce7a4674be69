#include "drivers/virtual_camera/virtual_stream.hpp"

#include <cmath>
#include <cstring>

namespace houghstream::virtual_camera {
namespace {

constexpr int kMaxDepthMm = 10000;

template <typename T>
OniStatus give(const T& value, void* data, const int* size) {
  if (*size != static_cast<int>(sizeof(T))) return ONI_STATUS_BAD_PARAMETER;
  std::memcpy(data, &value, sizeof(T));
  return ONI_STATUS_OK;
}

template <typename T>
OniStatus take(T& value, const void* data, int size) {
  if (size != static_cast<int>(sizeof(T))) return ONI_STATUS_BAD_PARAMETER;
  std::memcpy(&value, data, sizeof(T));
  return ONI_STATUS_OK;
}

float angle(int size, double focal_px) {
  return static_cast<float>(2.0 * std::atan(0.5 * size / focal_px));
}

int bytes_per_pixel(OniSensorType type) {
  return type == ONI_SENSOR_DEPTH ? 2 : 3;
}

}  // namespace

VirtualStream::VirtualStream(VirtualDevice& device, const VirtualSensor& sensor)
    : device_(device), sensor_(sensor), mode_(sensor.modes.at(0)), camera_(sensor.cameras.at(0)) {}

OniVideoMode VirtualStream::mode() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return mode_;
}

OniBool VirtualStream::isPropertySupported(int property) {
  switch (property) {
    case ONI_STREAM_PROPERTY_VIDEO_MODE:
    case ONI_STREAM_PROPERTY_CROPPING:
    case ONI_STREAM_PROPERTY_HORIZONTAL_FOV:
    case ONI_STREAM_PROPERTY_VERTICAL_FOV:
    case ONI_STREAM_PROPERTY_STRIDE:
    case ONI_STREAM_PROPERTY_MIRRORING: return TRUE;
    case ONI_STREAM_PROPERTY_MAX_VALUE:
    case ONI_STREAM_PROPERTY_MIN_VALUE: return sensor_.type == ONI_SENSOR_DEPTH;
    case ONI_STREAM_PROPERTY_AUTO_WHITE_BALANCE:
    case ONI_STREAM_PROPERTY_AUTO_EXPOSURE:
    case ONI_STREAM_PROPERTY_EXPOSURE:
    case ONI_STREAM_PROPERTY_GAIN: return sensor_.type == ONI_SENSOR_COLOR;
    default: return FALSE;
  }
}

OniStatus VirtualStream::getProperty(int property, void* data, int* size) {
  if (!isPropertySupported(property)) return ONI_STATUS_NOT_SUPPORTED;
  const std::lock_guard<std::mutex> lock(mutex_);
  switch (property) {
    case ONI_STREAM_PROPERTY_VIDEO_MODE: return give(mode_, data, size);
    case ONI_STREAM_PROPERTY_CROPPING:
      return give(OniCropping{FALSE, 0, 0, mode_.resolutionX, mode_.resolutionY}, data, size);
    case ONI_STREAM_PROPERTY_HORIZONTAL_FOV: return give(angle(camera_.width, camera_.fx), data, size);
    case ONI_STREAM_PROPERTY_VERTICAL_FOV: return give(angle(camera_.height, camera_.fy), data, size);
    case ONI_STREAM_PROPERTY_STRIDE: return give(mode_.resolutionX * bytes_per_pixel(sensor_.type), data, size);
    case ONI_STREAM_PROPERTY_MIRRORING: return give(mirrored_, data, size);
    case ONI_STREAM_PROPERTY_MAX_VALUE: return give(kMaxDepthMm, data, size);
    case ONI_STREAM_PROPERTY_MIN_VALUE: return give(0, data, size);
    case ONI_STREAM_PROPERTY_AUTO_WHITE_BALANCE: return give(auto_white_balance_, data, size);
    case ONI_STREAM_PROPERTY_AUTO_EXPOSURE: return give(auto_exposure_, data, size);
    case ONI_STREAM_PROPERTY_EXPOSURE: return give(exposure_, data, size);
    default: return give(gain_, data, size);
  }
}

OniStatus VirtualStream::setProperty(int property, const void* data, int size) {
  if (!isPropertySupported(property)) return ONI_STATUS_NOT_SUPPORTED;
  if (property == ONI_STREAM_PROPERTY_VIDEO_MODE) {
    OniVideoMode mode;
    const OniStatus status = take(mode, data, size);
    return status == ONI_STATUS_OK ? set_mode(mode) : status;
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  switch (property) {
    case ONI_STREAM_PROPERTY_MIRRORING: return take(mirrored_, data, size);
    case ONI_STREAM_PROPERTY_AUTO_WHITE_BALANCE: return take(auto_white_balance_, data, size);
    case ONI_STREAM_PROPERTY_AUTO_EXPOSURE: return take(auto_exposure_, data, size);
    case ONI_STREAM_PROPERTY_EXPOSURE: return take(exposure_, data, size);
    case ONI_STREAM_PROPERTY_GAIN: return take(gain_, data, size);
    default: return ONI_STATUS_NOT_SUPPORTED;
  }
}

OniStatus VirtualStream::set_mode(const OniVideoMode& mode) {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (std::size_t i = 0; i < sensor_.modes.size(); ++i) {
    if (std::memcmp(&sensor_.modes[i], &mode, sizeof(mode)) != 0) continue;
    mode_ = mode;
    camera_ = sensor_.cameras.at(i);
    return ONI_STATUS_OK;
  }
  return ONI_STATUS_BAD_PARAMETER;
}

OniStatus VirtualStream::start() {
  const std::lock_guard<std::mutex> lock(sending_);
  running_ = true;
  return ONI_STATUS_OK;
}

void VirtualStream::stop() {
  const std::lock_guard<std::mutex> lock(sending_);
  running_ = false;
}

bool VirtualStream::is_running() const {
  const std::lock_guard<std::mutex> lock(sending_);
  return running_;
}

void VirtualStream::send(const cv::Mat& image, int number, std::uint64_t device_us) {
  const std::lock_guard<std::mutex> lock(sending_);
  if (!running_) return;
  const OniVideoMode now = mode();
  if (image.cols != now.resolutionX || image.rows != now.resolutionY) return;
  OniFrame* frame = getServices().acquireFrame();
  if (frame == nullptr) return;
  cv::Mat target(image.rows, image.cols, image.type(), frame->data);
  OniBool mirrored = FALSE;
  int size = sizeof(mirrored);
  getProperty(ONI_STREAM_PROPERTY_MIRRORING, &mirrored, &size);
  if (mirrored != FALSE) {
    cv::flip(image, target, 1);
  } else {
    image.copyTo(target);
  }
  frame->dataSize = static_cast<int>(target.total() * target.elemSize());
  frame->sensorType = sensor_.type;
  frame->timestamp = device_us;
  frame->frameIndex = number;
  frame->width = image.cols;
  frame->height = image.rows;
  frame->videoMode = now;
  frame->croppingEnabled = FALSE;
  frame->cropOriginX = frame->cropOriginY = 0;
  frame->stride = static_cast<int>(target.step);
  raiseNewFrame(frame);
  getServices().releaseFrame(frame);
}

}  // namespace houghstream::virtual_camera
