#pragma once

#include <filesystem>
#include <vector>

namespace houghstream {

/// Times from a frame message's arrival at the observer to the arrival of its results, milliseconds.
struct Latencies {
  std::vector<double> detect_ms;  ///< frame to detections
  std::vector<double> pose_ms;    ///< detections to poses
  std::vector<double> total_ms;   ///< frame to poses
  int frames = 0;                 ///< frame messages seen
};

/// Reads hs-observe's CSV: a header with the columns utime, t_frame, t_detections and t_poses among others; seconds,
/// empty where the message never came. Throws InputError.
Latencies read_latencies(const std::filesystem::path& csv_file);

}  // namespace houghstream
