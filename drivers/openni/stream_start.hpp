#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/openni/timestamp_pairing.hpp"

namespace houghstream::openni {

/// Holds an image of a stream in a size small enough to store.
struct ImageThumbnail {
  std::int64_t time_us = 0;
  cv::Mat some_pixels;  ///< every eighth of each row and column
};

ImageThumbnail make_thumbnail(const SensorImage& image);

/// Holds the first images of a camera's two streams.
struct FirstImages {
  std::vector<ImageThumbnail> depth;
  std::vector<ImageThumbnail> colour;
  std::vector<ImageThumbnail>& of(SensorImage::Sensor sensor) {
    return sensor == SensorImage::Sensor::kDepth ? depth : colour;
  }
};

/// Gives the start of a recorded stream on the device's clock.
struct StreamStart {
  std::int64_t device_us = 0;
  double difference = 0.0;  ///< mean over images and values: 0 where the recording is without loss
  std::size_t images = 0;   ///< recorded ones that were seen live
};

struct RecordedStarts {
  StreamStart depth;
  StreamStart colour;
};

/// Finds the first images of both recorded streams, with times that count from some zero, among those that were seen
/// live, with times of the device: intervals are the same in both. Either may lack images, as where this machine is too
/// busy to see all. Both streams start within half a second of one another. Where several places fit equally well (a
/// sensor that sees nothing, an image that comes again), those with most images, then those closest together, then the
/// earliest. Nothing where no places have four images of each stream, or half of those of a short recording.
std::optional<RecordedStarts> find_stream_starts(const FirstImages& recorded, const FirstImages& live);

}  // namespace houghstream::openni
