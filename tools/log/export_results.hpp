#pragma once

#include <filesystem>

#include "tools/log/good_events.hpp"

namespace houghstream {

/// Writes the detections and poses of a log, joined by frame and detection, one row a detection: CSV with a header
/// line, or JSON with a list of frames, empty ones too, with the stages' times. Fields are those of detection_t and
/// object_pose_t in metres; what is not known is empty in CSV and null in JSON. Returns the number of frames. Throws
/// InputError where the log holds no detections, or the file cannot be written.
std::int64_t export_results_csv(const std::filesystem::path& log_file, const std::filesystem::path& out_file,
                                LossAccount& losses);
std::int64_t export_results_json(const std::filesystem::path& log_file, const std::filesystem::path& out_file,
                                 LossAccount& losses);

}  // namespace houghstream
