#pragma once

#include <cstddef>
#include <filesystem>

namespace houghstream::openni {

/// Ends a .oni file that OpenNI2's recorder was killed over, so that OpenNI2 plays it: what follows the last whole
/// image goes, each stream states the images that are there, and gets its seek table. Returns the number of images.
/// Colour and depth each begin at zero, as OpenNI2's recorder has left them: when they were taken is not in the file.
/// Throws InputError where it is no recording of OpenNI2's (version 1.0.1), holds no image, or cannot be written; a
/// file that cannot be read so far is left as it was.
std::size_t repair_oni(const std::filesystem::path& file);

/// Repairs a copy; `from` stays as it is. Throws InputError likewise, and then there is no copy.
std::size_t copy_repaired_oni(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace houghstream::openni
