#pragma once

#include <mutex>

#include "drivers/virtual_camera/camera_images.hpp"
#include "drivers/virtual_camera/driver_api.hpp"

namespace houghstream::virtual_camera {

/// The modes that a sensor offers, the first one at the start, and the camera of each.
struct VirtualSensor {
  OniSensorType type = ONI_SENSOR_DEPTH;
  std::vector<OniVideoMode> modes;
  std::vector<Camera> cameras;
};

class VirtualDevice;

/// Provides one sensor's stream: answers OpenNI2's questions, and sends the images that the device hands it.
class VirtualStream : public oni::driver::StreamBase {
 public:
  VirtualStream(VirtualDevice& device, const VirtualSensor& sensor);

  OniBool isPropertySupported(int property) override;
  OniStatus getProperty(int property, void* data, int* size) override;
  OniStatus setProperty(int property, const void* data, int size) override;
  OniStatus start() override;
  void stop() override;

  VirtualDevice& device() const { return device_; }
  OniSensorType type() const { return sensor_.type; }
  OniVideoMode mode() const;
  bool is_running() const;

  /// Sends an image (CV_8UC3 RGB or CV_16UC1) if the stream is running; `number` and `device_us` go with it.
  void send(const cv::Mat& image, int number, std::uint64_t device_us);

 private:
  OniStatus set_mode(const OniVideoMode& mode);

  VirtualDevice& device_;
  VirtualSensor sensor_;
  mutable std::mutex mutex_;
  OniVideoMode mode_;
  Camera camera_;            // camera of the mode
  OniBool mirrored_ = TRUE;  // default of real cameras, unless switched off
  OniBool auto_exposure_ = TRUE;
  OniBool auto_white_balance_ = TRUE;
  int exposure_ = 10;
  int gain_ = 100;
  mutable std::mutex sending_;  // held while an image is on its way, so that none comes after stop()
  bool running_ = false;
};

}  // namespace houghstream::virtual_camera
