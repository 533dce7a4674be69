#pragma once

#include <OpenNI.h>

#include <atomic>
#include <string>
#include <utility>

// Included by the .cpp files of this folder only.

namespace houghstream {

/// Hears that a camera was unplugged or has failed.
class Departure : public openni::OpenNI::DeviceDisconnectedListener, public openni::OpenNI::DeviceStateChangedListener {
 public:
  explicit Departure(std::string uri) : uri_(std::move(uri)) {
    openni::OpenNI::addDeviceDisconnectedListener(this);
    openni::OpenNI::addDeviceStateChangedListener(this);
  }
  ~Departure() override {
    openni::OpenNI::removeDeviceDisconnectedListener(this);
    openni::OpenNI::removeDeviceStateChangedListener(this);
  }
  void onDeviceDisconnected(const openni::DeviceInfo* info) override {
    if (uri_ == info->getUri()) gone = true;
  }
  void onDeviceStateChanged(const openni::DeviceInfo* info, openni::DeviceState state) override {
    if (uri_ == info->getUri() && state == openni::DEVICE_STATE_ERROR) gone = true;
  }
  std::atomic<bool> gone{false};

 private:
  std::string uri_;
};

}  // namespace houghstream
