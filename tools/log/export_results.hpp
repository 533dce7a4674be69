#pragma once

#include <filesystem>

#include "tools/log/good_events.hpp"

namespace houghstream::log_tools {

/// Writes the detections and poses of a log, joined by frame (of all cameras, in the order of time) and detection (of
/// all detectors that worked on the frame, strongest first), one row a detection: CSV with a header line, or JSON with
/// a list of frames, empty ones too, with the stages' times, which are sums over the detectors. What hs-pose --follow
/// follows from frame to frame has detection -1, the score of the detection that it was found by, and neither box nor
/// centre; where the frame's detections hold the same object, it is written once, as one of these. Poses of no
/// detections in the log are counted in `losses`. Fields are those of detection_t and object_pose_t in metres; what is
/// not known is empty in CSV and null in JSON. Returns the number of frames. Throws InputError where the log holds
/// neither detections nor poses of followed objects, or the file cannot be written.
std::int64_t export_results_csv(const std::filesystem::path& log_file, const std::filesystem::path& out_file,
                                LossReport& losses);
std::int64_t export_results_json(const std::filesystem::path& log_file, const std::filesystem::path& out_file,
                                 LossReport& losses);

}  // namespace houghstream::log_tools
