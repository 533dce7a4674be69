#pragma once

#include <filesystem>

#include "tools/log/recording.hpp"

namespace houghstream::log_tools {

/// Writes a recording's frames as images_t to an LCM log that the stream replays, each at the time of its event or of
/// its capture. Returns the number of frames. Throws InputError where nothing can be imported or written.
std::int64_t import_log(const RecordingSettings& settings, const std::string& channel,
                        const std::filesystem::path& log_file, LossReport& losses);

}  // namespace houghstream::log_tools
