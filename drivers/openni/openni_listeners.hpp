#pragma once

#include <OpenNI.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <string>

#include "drivers/openni/openni_parts.hpp"

// What OpenNI2 calls from its own threads. Included by the .cpp files of this folder only.

namespace houghstream {

/// Images as they arrive, from OpenNI2's threads, in a queue.
class Inbox {
 public:
  void put(SensorImage image) {
    const std::lock_guard<std::mutex> lock(mutex_);
    images_.push_back(std::move(image));
    if (images_.size() > kCapacity) images_.pop_front();
    arrived_.notify_one();
  }
  std::optional<SensorImage> take(std::chrono::milliseconds patience) {
    std::unique_lock<std::mutex> lock(mutex_);
    if (!arrived_.wait_for(lock, patience, [&] { return !images_.empty(); })) return std::nullopt;
    SensorImage image = std::move(images_.front());
    images_.pop_front();
    return image;
  }
  void clear() {
    const std::lock_guard<std::mutex> lock(mutex_);
    images_.clear();
  }

 private:
  static constexpr std::size_t kCapacity = 60;  // a second of both sensors at 30 Hz

  std::mutex mutex_;
  std::condition_variable arrived_;
  std::deque<SensorImage> images_;
};

/// Every image counts, so it is taken the moment it arrives: a stream keeps its newest one only.
struct Listener : openni::VideoStream::NewFrameListener {
  Listener(Inbox& to, SensorImage::Sensor of) : inbox(to), sensor(of) {}
  void onNewFrame(openni::VideoStream& stream) override {
    std::optional<SensorImage> image = read_image(stream, sensor);
    if (image) inbox.put(std::move(*image));
  }
  Inbox& inbox;
  SensorImage::Sensor sensor;
};

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
