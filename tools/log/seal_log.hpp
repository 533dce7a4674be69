#pragma once

#include <cstdint>
#include <filesystem>

namespace houghstream::log_tools {

/// Copies a whole log and seals it (pipeline/bus/log_seal.hpp): from then on every reader of ours refuses an event of
/// which a bit has changed, and a log of which events are missing. Returns the number of events. Throws InputError where
/// the log is damaged: what cannot be trusted is not sealed.
std::int64_t seal_log(const std::filesystem::path& log_file, const std::filesystem::path& out_file);

}  // namespace houghstream::log_tools
