#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

#include "drivers/virtual_camera/script_watch.hpp"
#include "drivers/virtual_camera/virtual_stream.hpp"

namespace houghstream::virtual_camera {

/// Images by {width, height}: one test pattern for each mode, or a scene.
using ImagesBySize = std::map<std::pair<int, int>, CameraImages>;

/// Simulates one camera: a thread that opens both shutters at the script's rate, and its streams.
class VirtualDevice : public oni::driver::DeviceBase {
 public:
  VirtualDevice(const ScriptWatch& script, const ImagesBySize& images, std::string serial);
  ~VirtualDevice() override;
  VirtualDevice(const VirtualDevice&) = delete;
  VirtualDevice& operator=(const VirtualDevice&) = delete;

  OniStatus getSensorInfoList(OniSensorInfo** infos, int* count) override;
  oni::driver::StreamBase* createStream(OniSensorType type) override;
  void destroyStream(oni::driver::StreamBase* stream) override;
  OniBool isPropertySupported(int property) override;
  OniStatus getProperty(int property, void* data, int* size) override;
  OniStatus setProperty(int property, const void* data, int size) override;
  OniBool isImageRegistrationModeSupported(OniImageRegistrationMode mode) override;

  /// Returns false where the script states that this camera cannot.
  bool synchronise();
  void unsynchronise() { synchronised_ = false; }

  /// Offset of an unregistered depth image from the colour image, to the right, pixels at a width of 640.
  static constexpr int kParallaxPx = 20;

 private:
  using Clock = std::chrono::steady_clock;
  struct LateColour {
    Clock::time_point due;
    int number = 0;
    std::uint64_t device_us = 0;
    cv::Mat image;
  };

  void run();
  OniStatus set_registration(OniImageRegistrationMode mode);
  bool is_registered_by_now();
  void open_shutters(int number, Clock::time_point now);
  std::vector<std::shared_ptr<VirtualStream>> streams();
  void send_late_colour(Clock::time_point now);
  std::uint64_t device_time_us(Clock::time_point time, const CameraScript& script) const;
  cv::Mat unregistered(const cv::Mat& depth_mm) const;

  const ScriptWatch& script_;
  const ImagesBySize& images_;
  std::string serial_;
  std::array<VirtualSensor, 2> sensors_;
  std::array<OniSensorInfo, 2> infos_{};
  std::atomic<bool> registered_{false};
  std::atomic<int> unregistered_left_{0};
  std::atomic<bool> synchronised_{false};
  std::mutex streams_mutex_;
  std::vector<std::shared_ptr<VirtualStream>> streams_;
  std::deque<LateColour> late_;
  Clock::time_point start_ = Clock::now();
  std::mutex mutex_;
  std::condition_variable end_;
  bool running_ = true;
  std::thread thread_;
};

}  // namespace houghstream::virtual_camera
