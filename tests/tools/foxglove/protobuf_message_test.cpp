#include "tools/foxglove/protobuf_message.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace houghstream::foxglove {
namespace {

TEST(ProtobufMessage, HasTheBytesOfTheSpecification) {
  // "08 96 01" is the example of https://protobuf.dev/programming-guides/encoding/: field 1, the varint 150.
  EXPECT_EQ(ProtobufMessage("google.protobuf.Timestamp").add_integer("seconds", 150).bytes(), "\x08\x96\x01");
  EXPECT_EQ(ProtobufMessage("google.protobuf.Timestamp").add_integer("seconds", -1).bytes(),
            "\x08\xff\xff\xff\xff\xff\xff\xff\xff\xff\x01");
  EXPECT_EQ(ProtobufMessage("foxglove.KeyValuePair").add_text("value", "testing").bytes(), "\x12\x07testing");
  EXPECT_EQ(ProtobufMessage("foxglove.Point2").add_number("x", 1.0).bytes(),
            std::string("\x09\0\0\0\0\0\0\xf0\x3f", 9));
  EXPECT_EQ(ProtobufMessage("foxglove.RawImage").add_integer("width", 258).bytes(), std::string("\x15\x02\x01\0\0", 5));
  EXPECT_EQ(ProtobufMessage("foxglove.CameraCalibration").add_numbers("D", {0.0, 1.0}).bytes(),
            std::string("\x2a\x10\0\0\0\0\0\0\0\0\0\0\0\0\0\0\xf0\x3f", 18))
      << "packed";
  const ProtobufMessage time = ProtobufMessage("google.protobuf.Timestamp").add_integer("nanos", 1);
  EXPECT_EQ(ProtobufMessage("foxglove.RawImage").add_message("timestamp", time).bytes(), "\x0a\x02\x10\x01");
}

TEST(ProtobufMessage, RefusesWhatTheTypeHasNot) {
  EXPECT_THROW(ProtobufMessage("foxglove.Nothing"), std::logic_error);
  ProtobufMessage image("foxglove.RawImage");
  EXPECT_THROW(image.add_text("colour", "x"), std::logic_error);
  EXPECT_THROW(image.add_text("width", "x"), std::logic_error);
  EXPECT_THROW(image.add_message("timestamp", ProtobufMessage("foxglove.Color")), std::logic_error);
}

TEST(EncodeDescriptor, HoldsTheTypeAndThoseThatItNames) {
  const std::string bytes = encode_descriptor("foxglove.SceneUpdate");
  for (const char* part : {"foxglove/SceneUpdate.proto", "ModelPrimitive", "google/protobuf/duration.proto",
                           ".foxglove.LinePrimitive.Type", "MATCHING_ID", "proto3"})
    EXPECT_NE(bytes.find(part), std::string::npos) << part;
  EXPECT_EQ(bytes.find("RawImage"), std::string::npos);
}

}  // namespace
}  // namespace houghstream::foxglove
