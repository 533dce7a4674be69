#pragma once

#include <cstdint>
#include <deque>
#include <opencv2/core.hpp>
#include <optional>

#include "drivers/openni/camera_options.hpp"
#include "pipeline/types/frame.hpp"

namespace houghstream::openni {

/// Holds one image of one of a camera's two sensors, as it arrived.
struct SensorImage {
  enum class Sensor { kDepth, kColour };

  Sensor sensor = Sensor::kDepth;
  std::uint64_t device_us = 0;  ///< capture time on the device's clock, whose zero is arbitrary
  std::int64_t host_us = 0;     ///< arrival on the host's, microseconds since the epoch
  std::int64_t number = 0;      ///< the device's count of this sensor's images
  cv::Mat image;                ///< depth: CV_16UC1, millimetres, 0 = none; colour: CV_8UC3, BGR
};

/// A depth image and the colour image that was taken nearest to it.
struct ImagePair {
  SensorImage depth;
  SensorImage colour;
};

/// Returns the pair as a frame with the caller's utime.
RgbdFrame frame_of_pair(const ImagePair& pair, const Camera& camera, std::int64_t utime);

/// Returns the maximum time between depth and colour of a pair: half the time between two images, and some reserve for
/// jitter.
std::int64_t pairing_tolerance_us(const CameraMode& mode);

/// Brings depth and colour together by their capture times, whichever arrives first and however late. The last colour
/// that has arrived would often be another moment's: where something moves, its colour would lie beside its depth.
class TimestampPairing {
 public:
  /// Images further apart never make a pair. Half the time between two images of a sensor pairs whatever the phase
  /// between the sensors is; a little more allows for jitter.
  explicit TimestampPairing(std::int64_t tolerance_us) : tolerance_us_(tolerance_us) {}

  /// Adds an image and returns the pair that it completes. Each image is used once; those older than a pair's are
  /// dropped. A sensor's time that falls shows that its clock has jumped: the waiting images of that sensor are
  /// dropped.
  std::optional<ImagePair> put(SensorImage image);

  /// Returns the number of depth images dropped so far because no colour image was taken near them.
  std::int64_t unpaired() const { return unpaired_; }

  /// Drops all waiting images.
  void clear();

  /// Maximum number of images of a sensor that wait for the other; more are dropped, the oldest first. It is half a
  /// second at 30 Hz.
  static constexpr std::size_t kMaxUnpaired = 16;

 private:
  using Queue = std::deque<SensorImage>;

  std::int64_t distance_us(const SensorImage& a, const SensorImage& b) const;
  void give_up_front(Queue& queue, std::size_t count);
  void give_up_older(Queue& queue, const SensorImage& image);

  std::int64_t tolerance_us_;
  std::int64_t unpaired_ = 0;
  Queue depth_;
  Queue colour_;
};

}  // namespace houghstream::openni
