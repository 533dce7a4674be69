#include "pipeline/messages/wire_reader.hpp"

#include "pipeline/base/checks.hpp"

namespace houghstream {

ByteView WireReader::read_bytes(std::size_t size) {
  require(size <= left(), "{}: ends {} bytes early, a field of {} bytes starts at byte {} of {}", source_,
          size - left(), size, position_, bytes_.size);
  const ByteView field{bytes_.data + position_, size};
  position_ += size;
  return field;
}

std::uint64_t WireReader::read_big_endian(std::size_t size) {
  const ByteView field = read_bytes(size);
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < size; ++i) value = value << 8U | field.data[i];
  return value;
}

std::int8_t WireReader::read_int8() {
  return static_cast<std::int8_t>(static_cast<std::uint8_t>(read_big_endian(1)));
}

std::int16_t WireReader::read_int16() {
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(read_big_endian(2)));
}

std::int32_t WireReader::read_int32() {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(read_big_endian(4)));
}

std::int64_t WireReader::read_int64() {
  return static_cast<std::int64_t>(read_big_endian(8));
}

std::size_t WireReader::read_count(std::size_t min_bytes) {
  const std::int32_t count = read_int32();
  require(count >= 0, "{}: a count of {} at byte {}, expected 0 or more", source_, count, position_ - 4);
  require(static_cast<std::size_t>(count) <= left() / min_bytes,
          "{}: a count of {} at byte {}, expected at most {} in the {} bytes that are left", source_, count,
          position_ - 4, left() / min_bytes, left());
  return static_cast<std::size_t>(count);
}

std::string WireReader::read_string() {
  const std::size_t size = read_count(1);
  require(size >= 1, "{}: a string of 0 bytes at byte {}, expected its closing zero", source_, position_ - 4);
  const ByteView field = read_bytes(size);
  require(field.data[size - 1] == 0, "{}: the string before byte {} has no closing zero", source_, position_);
  return {reinterpret_cast<const char*>(field.data), size - 1};
}

}  // namespace houghstream
