#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <vector>

#include "drivers/virtual_camera/virtual_device.hpp"

namespace houghstream::virtual_camera {

/// Stands in for OpenNI2: provides buffers for a stream's images, and takes them.
class TakenImages {
 public:
  struct Image {
    OniFrame frame{};
    cv::Mat image;
  };

  explicit TakenImages(oni::driver::StreamBase& stream) {
    services_.streamServices = this;
    services_.OniStreamServices::getDefaultRequiredFrameSize = [](void*) { return kRoom; };
    services_.OniStreamServices::acquireFrame = [](void* self) { return static_cast<TakenImages*>(self)->acquire(); };
    services_.OniStreamServices::addFrameRef = [](void*, OniFrame*) {};
    services_.OniStreamServices::releaseFrame = [](void*, OniFrame*) {};
    stream.setServices(&services_);
    stream.setNewFrameCallback(&TakenImages::take, this);
  }

  /// Returns the first images as soon as there are so many; fewer where they do not come.
  std::vector<Image> wait(std::size_t count) {
    std::unique_lock<std::mutex> lock(mutex_);
    arrived_.wait_for(lock, std::chrono::seconds(20), [&] { return images_.size() >= count; });
    return images_;
  }

 private:
  static constexpr int kRoom = 1 << 20;

  OniFrame* acquire() {
    frame_.data = room_.data();
    return &frame_;
  }

  static void ONI_CALLBACK_TYPE take(oni::driver::StreamBase*, OniFrame* frame, void* cookie) {
    auto* self = static_cast<TakenImages*>(cookie);
    const int type = frame->sensorType == ONI_SENSOR_DEPTH ? CV_16UC1 : CV_8UC3;
    const cv::Mat image(frame->height, frame->width, type, frame->data, static_cast<std::size_t>(frame->stride));
    const std::lock_guard<std::mutex> lock(self->mutex_);
    self->images_.push_back({*frame, image.clone()});
    self->arrived_.notify_all();
  }

  oni::driver::StreamServices services_{};
  std::vector<unsigned char> room_ = std::vector<unsigned char>(kRoom);
  OniFrame frame_{};
  std::mutex mutex_;
  std::condition_variable arrived_;
  std::vector<Image> images_;
};

}  // namespace houghstream::virtual_camera
