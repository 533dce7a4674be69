#pragma once

#include <filesystem>
#include <vector>

#include "tools/evaluate/metrics/evaluated_frame.hpp"

namespace houghstream {

/// Name of the file that hs-evaluate writes beside its report.
inline constexpr const char* kSearchTimesFile = "frames.csv";

/// Writes scene,image_id,detect_ms,pose_ms,detections,poses of each frame with detections: the sums of the stages whose
/// names begin with "detect." and "pose.", empty where there are none. Throws InputError where it cannot be written.
void write_search_times(const std::vector<EvaluatedFrame>& frames, const std::filesystem::path& file);

}  // namespace houghstream
