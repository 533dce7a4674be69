#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>

#include "pipeline/base/checks.hpp"

namespace houghstream::ros_bag {

/// Refers to bytes that belong to somebody else.
struct ByteRange {
  const std::uint8_t* data = nullptr;
  std::size_t size = 0;
};

/// Walks through bytes as ROS 1 serialises them: numbers are little-endian, a text follows its length. Every step is
/// checked against the end: throws InputError naming `source` instead of reading past it.
class ByteReader {
 public:
  ByteReader(ByteRange bytes, std::string source) : bytes_(bytes), source_(std::move(source)) {}

  template <typename Number>
  Number read() {
    Number number{};
    std::memcpy(&number, read_bytes(sizeof number).data, sizeof number);
    return number;
  }

  ByteRange read_bytes(std::size_t size) {
    require(size <= left(), "{}: {} bytes left, expected {} more: it is cut or damaged", source_, left(), size);
    const ByteRange range{bytes_.data + position_, size};
    position_ += size;
    return range;
  }

  /// Returns the bytes that follow their length, a uint32.
  ByteRange read_sized() { return read_bytes(read<std::uint32_t>()); }

  std::string read_text() {
    const ByteRange text = read_sized();
    return {reinterpret_cast<const char*>(text.data), text.size};
  }

  /// Throws InputError unless all bytes have been read.
  void require_end() const {
    require(left() == 0, "{}: {} bytes behind its end, expected none: it is damaged", source_, left());
  }

  std::size_t left() const { return bytes_.size - position_; }
  const std::string& source() const { return source_; }

 private:
  ByteRange bytes_;
  std::string source_;
  std::size_t position_ = 0;
};

}  // namespace houghstream::ros_bag
