#include <fmt/format.h>

#include <array>
#include <map>
#include <set>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "tools/foxglove/protobuf_message.hpp"

namespace houghstream::foxglove {
namespace {

/// A message type: its full name, and its fields as "[repeated ]TYPE NAME=NUMBER; ...". A type without a package is of
/// the message's own.
struct TypeText {
  const char* name;
  const char* fields;
};

// The types of Foxglove that are written here, and those that their fields name, with the numbers of
// https://github.com/foxglove/foxglove-sdk (schemas/proto); the test of the MCAP export compares them with the
// published ones. Fields that are newer than 2024 are left out: no reader needs them.
constexpr std::array<TypeText, 35> kTypes = {{
    {"google.protobuf.Timestamp", "int64 seconds=1; int32 nanos=2"},
    {"google.protobuf.Duration", "int64 seconds=1; int32 nanos=2"},
    {"foxglove.Vector3", "double x=1; double y=2; double z=3"},
    {"foxglove.Quaternion", "double x=1; double y=2; double z=3; double w=4"},
    {"foxglove.Pose", "Vector3 position=1; Quaternion orientation=2"},
    {"foxglove.Point2", "double x=1; double y=2"},
    {"foxglove.Point3", "double x=1; double y=2; double z=3"},
    {"foxglove.Color", "double r=1; double g=2; double b=3; double a=4"},
    {"foxglove.KeyValuePair", "string key=1; string value=2"},
    {"foxglove.CompressedImage",
     "google.protobuf.Timestamp timestamp=1; bytes data=2; string format=3; string frame_id=4"},
    {"foxglove.RawImage",
     "google.protobuf.Timestamp timestamp=1; fixed32 width=2; fixed32 height=3; string encoding=4; fixed32 step=5; "
     "bytes data=6; string frame_id=7"},
    {"foxglove.CameraCalibration",
     "google.protobuf.Timestamp timestamp=1; fixed32 width=2; fixed32 height=3; string distortion_model=4; "
     "repeated double D=5; repeated double K=6; repeated double R=7; repeated double P=8; string frame_id=9"},
    {"foxglove.FrameTransform",
     "google.protobuf.Timestamp timestamp=1; string parent_frame_id=2; string child_frame_id=3; Vector3 translation=4; "
     "Quaternion rotation=5"},
    {"foxglove.FrameTransforms", "repeated FrameTransform transforms=1"},
    {"foxglove.CircleAnnotation",
     "google.protobuf.Timestamp timestamp=1; Point2 position=2; double diameter=3; double thickness=4; "
     "Color fill_color=5; Color outline_color=6; repeated KeyValuePair metadata=7"},
    {"foxglove.PointsAnnotation",
     "google.protobuf.Timestamp timestamp=1; Type type=2; repeated Point2 points=3; Color outline_color=4; "
     "repeated Color outline_colors=5; Color fill_color=6; double thickness=7; repeated KeyValuePair metadata=8"},
    {"foxglove.TextAnnotation",
     "google.protobuf.Timestamp timestamp=1; Point2 position=2; string text=3; double font_size=4; "
     "Color text_color=5; Color background_color=6; repeated KeyValuePair metadata=7"},
    {"foxglove.ImageAnnotations",
     "repeated CircleAnnotation circles=1; repeated PointsAnnotation points=2; repeated TextAnnotation texts=3"},
    {"foxglove.ArrowPrimitive",
     "Pose pose=1; double shaft_length=2; double shaft_diameter=3; double head_length=4; double head_diameter=5; "
     "Color color=6"},
    {"foxglove.CubePrimitive", "Pose pose=1; Vector3 size=2; Color color=3"},
    {"foxglove.SpherePrimitive", "Pose pose=1; Vector3 size=2; Color color=3"},
    {"foxglove.CylinderPrimitive",
     "Pose pose=1; Vector3 size=2; double bottom_scale=3; double top_scale=4; Color color=5"},
    {"foxglove.LinePrimitive",
     "Type type=1; Pose pose=2; double thickness=3; bool scale_invariant=4; repeated Point3 points=5; Color color=6; "
     "repeated Color colors=7; repeated fixed32 indices=8"},
    {"foxglove.TriangleListPrimitive",
     "Pose pose=1; repeated Point3 points=2; Color color=3; repeated Color colors=4; repeated fixed32 indices=5"},
    {"foxglove.TextPrimitive",
     "Pose pose=1; bool billboard=2; double font_size=3; bool scale_invariant=4; Color color=5; string text=6"},
    {"foxglove.ModelPrimitive",
     "Pose pose=1; Vector3 scale=2; Color color=3; bool override_color=4; string url=5; string media_type=6; "
     "bytes data=7"},
    {"foxglove.SceneEntityDeletion", "google.protobuf.Timestamp timestamp=1; Type type=2; string id=3"},
    {"foxglove.SceneEntity",
     "google.protobuf.Timestamp timestamp=1; string frame_id=2; string id=3; google.protobuf.Duration lifetime=4; "
     "bool frame_locked=5; repeated KeyValuePair metadata=6; repeated ArrowPrimitive arrows=7; "
     "repeated CubePrimitive cubes=8; repeated SpherePrimitive spheres=9; repeated CylinderPrimitive cylinders=10; "
     "repeated LinePrimitive lines=11; repeated TriangleListPrimitive triangles=12; repeated TextPrimitive texts=13; "
     "repeated ModelPrimitive models=14"},
    {"foxglove.SceneUpdate", "repeated SceneEntityDeletion deletions=1; repeated SceneEntity entities=2"},
    // The types that describe types: google/protobuf/descriptor.proto.
    {"google.protobuf.FileDescriptorSet", "repeated FileDescriptorProto file=1"},
    {"google.protobuf.FileDescriptorProto",
     "string name=1; string package=2; repeated string dependency=3; repeated DescriptorProto message_type=4; "
     "string syntax=12"},
    {"google.protobuf.DescriptorProto",
     "string name=1; repeated FieldDescriptorProto field=2; repeated EnumDescriptorProto enum_type=4"},
    {"google.protobuf.FieldDescriptorProto",
     "string name=1; int32 number=3; int32 label=4; int32 type=5; string type_name=6"},
    {"google.protobuf.EnumDescriptorProto", "string name=1; repeated EnumValueDescriptorProto value=2"},
    {"google.protobuf.EnumValueDescriptorProto", "string name=1; int32 number=2"},
}};

/// Enumerations: the full name of each, and its values as "NAME=NUMBER; ...".
constexpr std::array<TypeText, 3> kEnumerations = {{
    {"foxglove.PointsAnnotation.Type", "UNKNOWN=0; POINTS=1; LINE_LOOP=2; LINE_STRIP=3; LINE_LIST=4"},
    {"foxglove.LinePrimitive.Type", "LINE_STRIP=0; LINE_LOOP=1; LINE_LIST=2"},
    {"foxglove.SceneEntityDeletion.Type", "MATCHING_ID=0; ALL=1"},
}};

std::vector<std::string> split(const std::string& text, const std::string& between) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t end = 0; end != std::string::npos; begin = end + between.size()) {
    end = text.find(between, begin);
    parts.push_back(text.substr(begin, end - begin));
  }
  return parts;
}

/// Returns name and number of "NAME=NUMBER".
std::pair<std::string, int> parse_numbered(const std::string& text) {
  const std::size_t equals = text.find('=');
  return {text.substr(0, equals), std::stoi(text.substr(equals + 1))};
}

std::string package_of(const std::string& type) {
  return type.substr(0, type.rfind('.'));
}

std::string short_name(const std::string& type) {
  return type.substr(type.rfind('.') + 1);
}

const TypeText* find_enumeration(const std::string& name) {
  for (const TypeText& enumeration : kEnumerations) {
    if (name == enumeration.name) return &enumeration;
  }
  return nullptr;
}

void set_type(MessageField& field, const std::string& word, const std::string& message) {
  static const std::map<std::string, FieldType> scalars = {
      {"double", FieldType::kDouble},   {"int64", FieldType::kInt64}, {"int32", FieldType::kInt32},
      {"fixed32", FieldType::kFixed32}, {"bool", FieldType::kBool},   {"string", FieldType::kString},
      {"bytes", FieldType::kBytes}};
  const auto scalar = scalars.find(word);
  if (scalar != scalars.end()) {
    field.type = scalar->second;
  } else if (find_enumeration(message + "." + word) != nullptr) {
    field.type = FieldType::kEnum;
    field.type_name = message + "." + word;
  } else {
    field.type = FieldType::kMessage;
    field.type_name = word.find('.') == std::string::npos ? package_of(message) + "." + word : word;
  }
}

std::vector<MessageField> parse_fields(const TypeText& type) {
  std::vector<MessageField> fields;
  for (const std::string& text : split(type.fields, "; ")) {
    std::vector<std::string> words = split(text, " ");
    MessageField field;
    field.repeated = words.front() == "repeated";
    if (field.repeated) words.erase(words.begin());
    set_type(field, words.at(0), type.name);
    std::tie(field.name, field.number) = parse_numbered(words.at(1));
    fields.push_back(std::move(field));
  }
  return fields;
}

using TypeTable = std::map<std::string, std::vector<MessageField>>;

TypeTable make_table() {
  TypeTable table;
  for (const TypeText& type : kTypes) table[type.name] = parse_fields(type);
  return table;
}

void collect_types(const std::string& type, std::set<std::string>& found) {
  if (!found.insert(type).second) return;
  for (const MessageField& field : message_fields(type)) {
    if (field.type == FieldType::kMessage) collect_types(field.type_name, found);
  }
}

ProtobufMessage describe_enumeration(const TypeText& enumeration) {
  ProtobufMessage description("google.protobuf.EnumDescriptorProto");
  description.add_text("name", short_name(enumeration.name));
  for (const std::string& text : split(enumeration.fields, "; ")) {
    const auto [name, number] = parse_numbered(text);
    ProtobufMessage value("google.protobuf.EnumValueDescriptorProto");
    description.add_message("value", value.add_text("name", name).add_integer("number", number));
  }
  return description;
}

ProtobufMessage describe_type(const std::string& type) {
  constexpr int kOptional = 1;  // the labels of FieldDescriptorProto
  constexpr int kRepeated = 3;
  ProtobufMessage description("google.protobuf.DescriptorProto");
  description.add_text("name", short_name(type));
  for (const MessageField& field : message_fields(type)) {
    ProtobufMessage part("google.protobuf.FieldDescriptorProto");
    part.add_text("name", field.name).add_integer("number", field.number);
    part.add_integer("label", field.repeated ? kRepeated : kOptional);
    part.add_integer("type", static_cast<int>(field.type));
    if (!field.type_name.empty()) part.add_text("type_name", "." + field.type_name);
    description.add_message("field", part);
    if (field.type == FieldType::kEnum)
      description.add_message("enum_type", describe_enumeration(*find_enumeration(field.type_name)));
  }
  return description;
}

/// Names the file as the publishers of its types do.
std::string file_of(const std::string& type) {
  if (type == "google.protobuf.Timestamp") return "google/protobuf/timestamp.proto";
  if (type == "google.protobuf.Duration") return "google/protobuf/duration.proto";
  return "foxglove/" + short_name(type) + ".proto";
}

ProtobufMessage describe_file(const std::string& name, const std::string& package) {
  ProtobufMessage file("google.protobuf.FileDescriptorProto");
  file.add_text("name", name).add_text("package", package).add_text("syntax", "proto3");
  return file;
}

}  // namespace

const std::vector<MessageField>& message_fields(const std::string& type) {
  static const TypeTable table = make_table();
  const auto found = table.find(type);
  if (found == table.end()) throw std::logic_error(fmt::format("no message type '{}'", type));
  return found->second;
}

std::string encode_descriptor(const std::string& type) {
  std::set<std::string> types;
  collect_types(type, types);
  ProtobufMessage own = describe_file(file_of(type), package_of(type));
  ProtobufMessage set("google.protobuf.FileDescriptorSet");
  for (const std::string& name : types) {
    if (package_of(name) == package_of(type)) {
      own.add_message("message_type", describe_type(name));
    } else {
      ProtobufMessage other = describe_file(file_of(name), package_of(name));
      set.add_message("file", other.add_message("message_type", describe_type(name)));
      own.add_text("dependency", file_of(name));
    }
  }
  return set.add_message("file", own).bytes();
}

}  // namespace houghstream::foxglove
