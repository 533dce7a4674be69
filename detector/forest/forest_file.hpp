#pragma once

#include <filesystem>

#include "detector/forest/forest.hpp"

namespace houghstream {

/// The forest file: the line "HOUGHSTREAM FOREST <version>", then little-endian: payload size (u64), CRC-32 of the
/// payload (u32), payload. The payload holds the feature and patch settings, the classes and all arrays, compressed
/// with zstd. Files of version 17, which are not compressed, and of version 16, whose leaves had votes and views in
/// twice the bytes, are read too.
constexpr int kForestFileVersion = 18;

/// Writes a new file beside `file` and renames it, so that a good forest is never half overwritten.
void save_forest(const Forest& forest, const std::filesystem::path& file);

/// Throws InputError naming the file when it is missing, truncated, corrupt, of another version, or when an index in
/// it points nowhere. Whether a program knows its profile and can search
/// by it is not asked here.
Forest load_forest(const std::filesystem::path& file);

}  // namespace houghstream
