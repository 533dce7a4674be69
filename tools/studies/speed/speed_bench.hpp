#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "pipeline/types/detection.hpp"
#include "pipeline/types/frame.hpp"

namespace houghstream {

/// Something whose time on a frame is measured beside that of others.
struct BenchmarkedDetector {
  std::string name;
  std::size_t frames = SIZE_MAX;     ///< maximum number of frames, for slow detectors
  std::int64_t instruction_set = 0;  ///< the only one of Highway's to use; 0 = the best of the processor
  double image_scale = 1.0;          ///< size of the frames that it is given over that of the scene's
  std::function<Detections(const RgbdFrame&)> detect;
};

/// Parses a detector of a command line: "NAME=FOREST", then any of ",threads=N" (default 2), ",reference",
/// ",set=SSE4|AVX2|AVX3" and so on (the names of Highway), ",frames=N", ",trees=N" (the first so many), ",scale=X",
/// ",threshold=X" and ",min-mass=X" (as of hs-evaluate, so that time and accuracy are of the same settings). Loads the
/// forest. Throws InputError naming the part that was not understood.
BenchmarkedDetector parse_contender(const std::string& text);

/// Returns the frame with its image `scale` times as large: colour interpolated, depth of the nearest pixel.
RgbdFrame resized_frame(const RgbdFrame& frame, double scale);

/// Holds the times of one detector's frames, milliseconds of wall time.
struct SpeedResult {
  std::vector<double> ms;                               ///< times by frame, in the order of processing
  std::map<std::string, std::vector<double>> stage_ms;  ///< likewise
  std::size_t detections = 0;                           ///< number in all frames
};

/// Measures every detector on a frame, then all on the next one, so that disturbances of the machine affect all alike.
/// The first one changes from frame to frame. Before that each detector of more than a few frames processes the first
/// one once, which is not counted. Results are in the order of the detectors. Throws InputError without frames.
std::vector<SpeedResult> measure_speed(const std::vector<BenchmarkedDetector>& contenders,
                                       const std::vector<RgbdFrame>& frames);

/// Returns {"NAME": {"ms": {"p10", "p50", "p90"}, "frames", "detections", "stage_ms": {"STAGE": median}}}.
nlohmann::json to_json(const std::vector<BenchmarkedDetector>& contenders, const std::vector<SpeedResult>& results);

/// Returns a table for the terminal, fastest first.
std::string speed_table(const std::vector<BenchmarkedDetector>& contenders, const std::vector<SpeedResult>& results);

}  // namespace houghstream
