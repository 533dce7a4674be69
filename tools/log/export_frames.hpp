#pragma once

#include <filesystem>

#include "tools/log/recording.hpp"

namespace houghstream::log_tools {

/// Writes a recording's frames as a scene folder in BOP format without objects: depth in millimetres as it is, colour
/// as PNG. Every frame needs a camera: its own or the settings'; one without is left out and counted. Returns the
/// number of frames. Throws InputError where nothing can be exported or written, or images of a scene are there
/// already.
std::int64_t export_bop(const RecordingSettings& settings, const std::filesystem::path& folder, LossReport& losses);

/// Writes NNNNNN_color.png, NNNNNN_depth.png (uint16 millimetres, 0 = none) and frames.csv (frame, utime, timestamp),
/// which the source uw:FOLDER reads again. Cameras are not needed. Returns and throws as export_bop().
std::int64_t export_pngs(const RecordingSettings& settings, const std::filesystem::path& folder, LossReport& losses);

}  // namespace houghstream::log_tools
