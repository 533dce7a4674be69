#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace houghstream::foxglove {

/// Type of a field; the numbers are those of google.protobuf.FieldDescriptorProto.
enum class FieldType : std::int8_t {
  kDouble = 1,
  kInt64 = 3,
  kInt32 = 5,
  kFixed32 = 7,
  kBool = 8,
  kString = 9,
  kMessage = 11,
  kBytes = 12,
  kEnum = 14
};

/// Describes a field of a message type.
struct MessageField {
  std::string name;
  int number = 0;
  FieldType type = FieldType::kDouble;
  std::string type_name;  ///< full name of its message or enumeration; "" where it is neither
  bool repeated = false;
};

/// Returns the fields of a message type of message_types.cpp by its full name, for instance "foxglove.RawImage". Throws
/// std::logic_error for another name.
const std::vector<MessageField>& message_fields(const std::string& type);

/// Returns what a reader needs to decode messages of a type: an encoded google.protobuf.FileDescriptorSet with this and
/// all types that its fields name. Throws std::logic_error for a name that message_fields() does not know.
std::string encode_descriptor(const std::string& type);

/// Encodes one message in the format of Protocol Buffers, field by field: each name is looked up in message_fields(),
/// so that a number and a type stand in one place. A repeated field is added several times. All functions throw
/// std::logic_error for a field that the type lacks or that is of another type.
class ProtobufMessage {
 public:
  explicit ProtobufMessage(const std::string& type);

  ProtobufMessage& add_number(const std::string& field, double value);
  /// Adds an integer, or the value of an enumeration.
  ProtobufMessage& add_integer(const std::string& field, std::int64_t value);
  ProtobufMessage& add_flag(const std::string& field, bool value);
  /// Adds a string or bytes; a string is UTF-8.
  ProtobufMessage& add_text(const std::string& field, std::string_view value);
  ProtobufMessage& add_message(const std::string& field, const ProtobufMessage& value);
  /// Adds all values of a repeated field of numbers at once.
  ProtobufMessage& add_numbers(const std::string& field, const std::vector<double>& values);

  const std::string& type() const { return type_; }
  const std::string& bytes() const { return bytes_; }

 private:
  const MessageField& find(const std::string& field, std::initializer_list<FieldType> types) const;
  void put_key(const MessageField& field, unsigned wire_type);
  void put_varint(std::uint64_t value);
  void put_bytes(const MessageField& field, std::string_view value);

  std::string type_;
  const std::vector<MessageField>& fields_;
  std::string bytes_;
};

}  // namespace houghstream::foxglove
