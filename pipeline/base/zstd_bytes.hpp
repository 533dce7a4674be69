#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace houghstream {

/// Returns the bytes as one frame of Zstandard (RFC 8878), which notes how many they are. Levels are zstd's, from 1 on:
/// a higher one takes longer and less space. The same bytes and level give the same frame with one version of zstd.
std::string compress_zstd(std::string_view bytes, int level);

/// Decompresses a frame of exactly `size` bytes to `to`. Throws InputError naming `source` where the frame is damaged
/// or says that it holds another number of bytes; what was written to `to` is undefined then.
void decompress_zstd(std::string_view frame, void* to, std::size_t size, std::string_view source);

}  // namespace houghstream
