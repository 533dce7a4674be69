#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace houghstream {

/// Refers to an encoded message, whose bytes belong to somebody else.
struct ByteView {
  const std::uint8_t* data = nullptr;
  std::size_t size = 0;
};

/// Walks through an encoded message without decoding it. Every step is checked against the end of the message:
/// throws InputError instead of reading past it, or where a count is negative or cannot fit.
class WireReader {
 public:
  /// `source` names the message in errors.
  WireReader(ByteView bytes, std::string source) : bytes_(bytes), source_(std::move(source)) {}

  std::int8_t read_int8();
  std::int16_t read_int16();
  std::int32_t read_int32();
  std::int64_t read_int64();
  /// A count of entries that take at least `min_bytes` each.
  std::size_t read_count(std::size_t min_bytes);
  std::string read_string();
  ByteView read_bytes(std::size_t size);
  void skip(std::size_t size) { read_bytes(size); }
  std::size_t left() const { return bytes_.size - position_; }
  const std::string& source() const { return source_; }

 private:
  std::uint64_t read_big_endian(std::size_t size);

  ByteView bytes_;
  std::string source_;
  std::size_t position_ = 0;
};

}  // namespace houghstream
