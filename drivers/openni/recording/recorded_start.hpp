#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/openni/timestamp_pairing.hpp"

namespace houghstream::openni {

/// An image of a stream, small enough to be remembered.
struct Remembered {
  std::int64_t time_us = 0;
  cv::Mat some_pixels;  ///< every eighth of each row and column
};

Remembered remember(const SensorImage& image);

/// Where a recorded stream begins on the device's clock.
struct RecordedStart {
  std::int64_t device_us = 0;
  double difference = 0.0;  ///< mean over images and values: 0 where the recording is without loss
  std::size_t images = 0;   ///< recorded ones that were seen live
};

/// Finds the first images of a recorded stream, with times that count from some zero, among those that were seen live,
/// with times of the device: intervals are the same in both. Either may lack an image. Where several places fit equally
/// well (a sensor that sees nothing), the one with most images, the earliest of those. Nothing where no place has at
/// least half of the recorded ones.
std::optional<RecordedStart> find_recorded_start(const std::vector<Remembered>& recorded,
                                                 const std::vector<Remembered>& live);

}  // namespace houghstream::openni
