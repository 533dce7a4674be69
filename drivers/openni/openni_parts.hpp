#pragma once

#include <OpenNI.h>

#include <atomic>
#include <chrono>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "drivers/openni/camera_choice.hpp"
#include "drivers/openni/timestamp_pairing.hpp"

// These functions convert OpenNI2's types to this project's. Only the .cpp files of this folder include them.

namespace houghstream::openni {

/// Keeps OpenNI2 running while an instance exists: it watches for cameras that come and go. Throws InputError where it
/// finds no driver.
class OpenniLibrary {
 public:
  OpenniLibrary();
  ~OpenniLibrary();
  OpenniLibrary(const OpenniLibrary&) = delete;
  OpenniLibrary& operator=(const OpenniLibrary&) = delete;
};

/// Notes that a camera was unplugged or has failed.
class DisconnectListener : public ::openni::OpenNI::DeviceDisconnectedListener,
                           public ::openni::OpenNI::DeviceStateChangedListener {
 public:
  explicit DisconnectListener(std::string uri) : uri_(std::move(uri)) {
    ::openni::OpenNI::addDeviceDisconnectedListener(this);
    ::openni::OpenNI::addDeviceStateChangedListener(this);
  }
  ~DisconnectListener() override {
    ::openni::OpenNI::removeDeviceDisconnectedListener(this);
    ::openni::OpenNI::removeDeviceStateChangedListener(this);
  }
  void onDeviceDisconnected(const ::openni::DeviceInfo* info) override {
    if (uri_ == info->getUri()) gone = true;
  }
  void onDeviceStateChanged(const ::openni::DeviceInfo* info, ::openni::DeviceState state) override {
    if (uri_ == info->getUri() && state == ::openni::DEVICE_STATE_ERROR) gone = true;
  }
  std::atomic<bool> gone{false};

 private:
  std::string uri_;
};

/// Throws InputError with OpenNI2's reason unless the status is ok.
void check_openni(::openni::Status status, const std::string& what);

::openni::SensorType openni_type(SensorImage::Sensor sensor);
CameraMode camera_mode_of(const ::openni::VideoMode& mode);

/// Returns a sensor's mode with a supported pixel format: RGB, or depth in millimetres or their tenths.
std::optional<::openni::VideoMode> find_mode(::openni::Device& device, SensorImage::Sensor sensor,
                                             const CameraMode& wanted);

/// The modes that depth and colour have in common.
std::vector<CameraMode> common_modes(::openni::Device& device);

/// Returns the serial number, or nothing where the driver does not state it.
std::string serial_of(const ::openni::Device& device);

/// The sensor of the image that is there first; nothing where none comes in time.
std::optional<SensorImage::Sensor> wait_for_image(::openni::VideoStream& depth, ::openni::VideoStream& colour,
                                                  std::chrono::milliseconds timeout);

/// Reads the stream's newest image, colour still as RGB: OpenCV would convert it with the help of other threads, for
/// which the one that reads a camera must not wait. Its image is empty where the device gave less than the frame
/// should hold.
std::optional<SensorImage> read_image(::openni::VideoStream& stream, SensorImage::Sensor sensor);

}  // namespace houghstream::openni
