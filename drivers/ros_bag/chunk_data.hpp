#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "drivers/ros_bag/byte_reader.hpp"

namespace houghstream::ros_bag {

/// Returns the records of a bag's chunk. `compression` is "none", "bz2" or "lz4" (frames of LZ4), `size` the bytes that
/// the chunk states to hold; memory grows with what is there, not with what is stated. Throws InputError naming
/// `source` where the compression is unknown, the bytes cannot be decompressed, or are not as many as stated.
std::vector<std::uint8_t> decompress_chunk(ByteRange bytes, const std::string& compression, std::size_t size,
                                           const std::string& source);

}  // namespace houghstream::ros_bag
