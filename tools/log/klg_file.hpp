#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <houghstream/images_t.hpp>
#include <optional>
#include <string>
#include <vector>

namespace houghstream::log_tools {

/// Reads a .klg recording (Logger2, Kintinuous, ElasticFusion): little-endian int32 frames, then for each int64 time in
/// microseconds, int32 bytes of depth, int32 bytes of colour, depth (uint16 millimetres, zlib unless of full size),
/// colour (JPEG unless of full size, then RGB). The file does not state the images' size.
class KlgFile {
 public:
  /// Throws InputError when the file cannot be read or its count is absurd.
  KlgFile(const std::filesystem::path& file, int width, int height);

  /// Returns the next frame as it was recorded, or nothing at the end. Throws InputError where the file is cut or
  /// damaged, since the next frame cannot be found then, and where the file continues behind the last frame.
  std::optional<images_t> next();

  /// Returns the bytes from the next frame to the end.
  std::uint64_t bytes_left() const { return size_ - position_; }

 private:
  std::vector<std::uint8_t> read(std::uint64_t bytes, const char* what);

  std::string file_;
  std::ifstream in_;
  int width_;
  int height_;
  std::uint64_t size_ = 0;
  std::uint64_t position_ = 0;  // position of the next frame
  std::int32_t frames_ = 0;
  std::int32_t index_ = 0;
};

}  // namespace houghstream::log_tools
