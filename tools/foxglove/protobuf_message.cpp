#include "tools/foxglove/protobuf_message.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "numbers are written as they lie in memory");

namespace houghstream::foxglove {
namespace {

// The kinds of encoding in https://protobuf.dev/programming-guides/encoding/.
constexpr unsigned kVarint = 0;
constexpr unsigned kFixed64 = 1;
constexpr unsigned kLengthDelimited = 2;
constexpr unsigned kFixed32 = 5;

template <typename Number>
void append_fixed(std::string& bytes, Number value) {
  const std::size_t at = bytes.size();
  bytes.resize(at + sizeof value);
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

}  // namespace

ProtobufMessage::ProtobufMessage(const std::string& type) : type_(type), fields_(message_fields(type)) {}

const MessageField& ProtobufMessage::find(const std::string& field, std::initializer_list<FieldType> types) const {
  const auto found =
      std::find_if(fields_.begin(), fields_.end(), [&](const MessageField& one) { return one.name == field; });
  if (found == fields_.end() || std::count(types.begin(), types.end(), found->type) == 0)
    throw std::logic_error(fmt::format("{}: no field '{}' of such a type", type_, field));
  return *found;
}

void ProtobufMessage::put_key(const MessageField& field, unsigned wire_type) {
  put_varint(static_cast<std::uint64_t>(field.number) << 3U | wire_type);
}

void ProtobufMessage::put_varint(std::uint64_t value) {
  for (; value >= 0x80; value >>= 7U) bytes_.push_back(static_cast<char>(value | 0x80U));
  bytes_.push_back(static_cast<char>(value));
}

void ProtobufMessage::put_bytes(const MessageField& field, std::string_view value) {
  put_key(field, kLengthDelimited);
  put_varint(value.size());
  bytes_.append(value);
}

ProtobufMessage& ProtobufMessage::add_number(const std::string& field, double value) {
  put_key(find(field, {FieldType::kDouble}), kFixed64);
  append_fixed(bytes_, value);
  return *this;
}

ProtobufMessage& ProtobufMessage::add_integer(const std::string& field, std::int64_t value) {
  const MessageField& found =
      find(field, {FieldType::kInt64, FieldType::kInt32, FieldType::kFixed32, FieldType::kEnum});
  if (found.type == FieldType::kFixed32) {
    put_key(found, kFixed32);
    append_fixed(bytes_, static_cast<std::uint32_t>(value));
  } else {
    put_key(found, kVarint);
    put_varint(static_cast<std::uint64_t>(value));
  }
  return *this;
}

ProtobufMessage& ProtobufMessage::add_flag(const std::string& field, bool value) {
  put_key(find(field, {FieldType::kBool}), kVarint);
  put_varint(value ? 1 : 0);
  return *this;
}

ProtobufMessage& ProtobufMessage::add_text(const std::string& field, std::string_view value) {
  put_bytes(find(field, {FieldType::kString, FieldType::kBytes}), value);
  return *this;
}

ProtobufMessage& ProtobufMessage::add_message(const std::string& field, const ProtobufMessage& value) {
  const MessageField& found = find(field, {FieldType::kMessage});
  if (found.type_name != value.type_)
    throw std::logic_error(fmt::format("{}: '{}' is a {}, not a {}", type_, field, found.type_name, value.type_));
  put_bytes(found, value.bytes_);
  return *this;
}

ProtobufMessage& ProtobufMessage::add_numbers(const std::string& field, const std::vector<double>& values) {
  std::string packed;
  for (const double value : values) append_fixed(packed, value);
  put_bytes(find(field, {FieldType::kDouble}), packed);
  return *this;
}

}  // namespace houghstream::foxglove
