#pragma once

#include <filesystem>

namespace houghstream::view {

/// Writes the video of one file into another, whose format its name tells, without encoding it again. Its frames get
/// the times of a constant rate, which a format that counts milliseconds has rounded. Throws InputError where one of
/// the two cannot be read or written.
void remux_video(const std::filesystem::path& from, const std::filesystem::path& to, double rate_hz);

}  // namespace houghstream::view
