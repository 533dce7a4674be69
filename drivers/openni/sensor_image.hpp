#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

namespace houghstream {

/// One image of one of a camera's two sensors, as it arrived.
struct SensorImage {
  enum class Sensor { kDepth, kColour };

  Sensor sensor = Sensor::kDepth;
  std::uint64_t device_us = 0;  ///< capture time on the device's clock, whose zero is arbitrary
  std::int64_t host_us = 0;     ///< arrival on the host's, microseconds since the epoch
  std::int64_t number = 0;      ///< the device's count of this sensor's images
  cv::Mat image;                ///< depth: CV_16UC1, millimetres, 0 = none; colour: CV_8UC3, BGR
};

}  // namespace houghstream
