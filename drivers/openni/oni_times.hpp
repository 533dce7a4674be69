#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace houghstream::openni {

/// The streams of a .oni file in the order in which they were attached to OpenNI2's recorder.
enum class OniNode : std::uint32_t { kFirst = 1, kSecond = 2 };

/// Counts the images of all streams of a recording. Throws InputError unless the file is a whole one of OpenNI2's
/// (version 1.0.1): records up to its end (OpenNI2 leaves space behind it), of each stream as many images as it states,
/// and those at the times of its seek table. OpenNI2 itself allocates as much memory as the file states, and plays as
/// many images.
std::size_t check_oni(const std::filesystem::path& file);

/// Adds `delay_us`, which is not negative, to all times of one stream in a finished .oni file: those of its images, of
/// its seek table and of its range. OpenNI2's recorder begins each stream at zero (OniRecorder.cpp), whenever its first
/// image was taken, so that the offset between two streams must be added afterwards. Throws InputError where the file
/// is not a whole recording of OpenNI2's (version 1.0.1), and then leaves it as it was.
void delay_oni_node(const std::filesystem::path& file, OniNode node, std::int64_t delay_us);

}  // namespace houghstream::openni
