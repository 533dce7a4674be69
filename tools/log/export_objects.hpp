#pragma once

#include <filesystem>

#include "tools/log/good_events.hpp"

namespace houghstream::log_tools {

/// Writes the objects of a log's objects_t: CSV with a row for each object after each frame, or JSON with a list of
/// frames, and for each object the history of its states, with time and reason of its end. Metres, radians. Returns the
/// number of frames. Throws InputError where the log holds no objects, or the file cannot be written.
std::int64_t export_objects_csv(const std::filesystem::path& log_file, const std::filesystem::path& out_file,
                                LossReport& losses);
std::int64_t export_objects_json(const std::filesystem::path& log_file, const std::filesystem::path& out_file,
                                 LossReport& losses);

}  // namespace houghstream::log_tools
