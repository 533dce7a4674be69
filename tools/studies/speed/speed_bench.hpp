#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/studies/speed/contender.hpp"

namespace houghstream {

/// What one contender's frames took, milliseconds of wall time.
struct SpeedResult {
  std::vector<double> ms;                               ///< by frame, in the order they were looked at
  std::map<std::string, std::vector<double>> stage_ms;  ///< likewise
  std::size_t detections = 0;                           ///< in all frames
};

/// Every contender looks at a frame, then all at the next one: what disturbs the machine disturbs all alike. Who begins
/// changes from frame to frame. Before that each that is to see more than a few frames looks at the first one once,
/// which is not counted. In the order of the contenders. Throws InputError without frames.
std::vector<SpeedResult> measure_speed(const std::vector<BenchmarkedDetector>& contenders,
                                       const std::vector<RgbdFrame>& frames);

/// {"NAME": {"ms": {"p10", "p50", "p90"}, "frames", "detections", "stage_ms": {"STAGE": median}}}
nlohmann::json to_json(const std::vector<BenchmarkedDetector>& contenders, const std::vector<SpeedResult>& results);

/// A table for the terminal, fastest first.
std::string speed_table(const std::vector<BenchmarkedDetector>& contenders, const std::vector<SpeedResult>& results);

}  // namespace houghstream
