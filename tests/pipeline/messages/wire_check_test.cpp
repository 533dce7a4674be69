#include "pipeline/messages/wire_check.hpp"

#include <gtest/gtest.h>

#include <houghstream/status_t.hpp>
#include <limits>

#include "pipeline/messages/messages.hpp"
#include "tests/expect_says.hpp"
#include "tests/pipeline/test_frame.hpp"
#include "tests/test_files.hpp"

namespace houghstream {
namespace {

std::vector<std::uint8_t> encoded_frame() {
  return encode_message(to_message(make_test_frame(1234567), WireFormat{}, 41));
}

ByteView view_of(const std::vector<std::uint8_t>& bytes) {
  return {bytes.data(), bytes.size()};
}

void put_int32(std::vector<std::uint8_t>& bytes, std::size_t position, std::int32_t value) {
  for (std::size_t i = 0; i < 4; ++i) {
    bytes[position + i] = static_cast<std::uint8_t>(static_cast<std::uint32_t>(value) >> (24 - 8 * i));
  }
}

// These are the positions of counts in an images_t: fingerprint, utime, n_images, 2 types, then the first image_t.
constexpr std::size_t kImageCount = 16;
constexpr std::size_t kFirstImageSize = kImageCount + 4 + 2 * 2 + 8 + 4 * 4;

TEST(WireCheck, FingerprintsAreThoseOfBotCore) {
  EXPECT_EQ(static_cast<std::uint64_t>(images_t::getHash()), 0x20ba4f05e8f5e33aULL);
  EXPECT_EQ(static_cast<std::uint64_t>(image_t::getHash()), 0x14739ffe13d5f5f0ULL);
}

TEST(WireCheck, HeaderIsReadWithoutDecoding) {
  const std::vector<std::uint8_t> bytes = encoded_frame();
  const FrameHeader header = read_frame_header(view_of(bytes));
  EXPECT_EQ(header.utime, 1234567);
  EXPECT_EQ(header.sequence, 41);
  EXPECT_EQ(read_utime(view_of(bytes), "test"), 1234567);
}

TEST(WireCheck, AFrameWithoutCounterHasNone) {
  images_t message = to_message(make_test_frame(5), WireFormat{}, 41);
  message.images[0].metadata.clear();
  message.images[0].nmetadata = 0;
  EXPECT_FALSE(read_frame_header(view_of(encode_message(message))).sequence.has_value());
}

TEST(WireCheck, AnUnreadableCounterIsRefused) {
  images_t message = to_message(make_test_frame(5), WireFormat{}, 41);
  message.images[0].metadata[2].value = {'4', 'x'};
  EXPECT_THROW(read_frame_header(view_of(encode_message(message))), InputError);
}

TEST(WireCheck, EveryCutIsRefused) {
  std::vector<std::uint8_t> bytes = encoded_frame();
  EXPECT_NO_THROW(decode_message<images_t>(view_of(bytes)));
  for (std::size_t size = 0; size < bytes.size(); size += 7) {
    EXPECT_THROW(decode_message<images_t>({bytes.data(), size}), InputError) << size;
    EXPECT_THROW(read_frame_header({bytes.data(), size}), InputError) << size;
  }
  bytes.push_back(0);
  EXPECT_THROW(decode_message<images_t>(view_of(bytes)), InputError);
  EXPECT_THROW(read_frame_header(view_of(bytes)), InputError);
}

TEST(WireCheck, NegativeAndAbsurdCountsAreRefused) {
  for (const std::size_t position : {kImageCount, kFirstImageSize}) {
    for (const std::int32_t count : {-1, -2147483647 - 1, 2147483647, 100000000}) {
      std::vector<std::uint8_t> bytes = encoded_frame();
      put_int32(bytes, position, count);
      EXPECT_THROW(decode_message<images_t>(view_of(bytes)), InputError) << position << " " << count;
      EXPECT_THROW(read_frame_header(view_of(bytes)), InputError) << position << " " << count;
    }
  }
}

TEST(WireCheck, AnotherTypeIsRefusedByName) {
  const std::vector<std::uint8_t> bytes = encoded_frame();
  expect_says(error_of([&] { decode_message<detections_t>(view_of(bytes)); }), {"20ba4f05e8f5e33a", "detections_t"});
}

TEST(WireCheck, DamagedResultsNeverCrash) {
  Detections detections;
  detections.frame = {"OPENNI_FRAME", 7};
  Detection detection;
  detection.class_id = 1;
  detection.class_name = "bowl";
  detection.rotations.resize(3);
  detections.detections = {detection};
  detections.stages = {{"detect.leaves", 3}};
  const std::vector<std::uint8_t> whole = encode_message(to_message(detections));
  EXPECT_EQ(decode_message<detections_t>(view_of(whole)).n_detections, 1);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::vector<std::uint8_t> bytes = whole;
    bytes[i] ^= 0xFFU;
    try {
      detections_from_message(decode_message<detections_t>(view_of(bytes)));
    } catch (const InputError&) {
      continue;  // refusing is right; anything else thrown, or a crash, is not
    }
  }
}

/// Returns the error of the check; empty where the message passes.
template <typename Message>
std::string fault_of(const Message& message) {
  const std::vector<std::uint8_t> bytes = encode_message(message);
  return error_of([&] { check_wire(view_of(bytes), Message::getHash(), Message::getTypeName()); });
}

TEST(WireCheck, NamesAndListsThatAreKeptAreNotAsLongAsMessages) {
  Detection detection;
  detection.class_name = std::string(kMaxNameLength, 'x');
  Detections detections;
  detections.frame = {std::string(999, 'C'), 7};
  detections.detections = {detection};
  detections.stages.assign(kMaxStages, {"detect.leaves", 3});
  EXPECT_EQ(fault_of(to_message(detections)), "");

  Detections longer = detections;
  longer.frame.channel += 'C';
  EXPECT_NE(fault_of(to_message(longer)).find("a channel of 1000 bytes"), std::string::npos);
  const std::vector<std::uint8_t> bytes = encode_message(to_message(longer));
  EXPECT_THROW(read_result_frame(view_of(bytes), "test"), InputError);
  longer = detections;
  longer.detections[0].class_name += 'x';
  EXPECT_NE(fault_of(to_message(longer)).find("a name of 256 bytes"), std::string::npos);
  longer = detections;
  longer.stages.push_back({"detect.more", 1});
  EXPECT_NE(fault_of(to_message(longer)).find("257 stages"), std::string::npos);
  longer.stages = {{"detect.leaves", std::numeric_limits<std::int64_t>::max()}};
  EXPECT_NE(fault_of(to_message(longer)).find("a stage of 9223372036854775807 us"), std::string::npos);

  status_t status{};
  status.process = "hs-detect";
  status.last_error = std::string(70000, 'e');
  EXPECT_NE(fault_of(status).find("expected at most 65536"), std::string::npos);
}

TEST(WireCheck, AFrameOfMoreBytesThanAnyImageHasIsRefused) {
  images_t message = to_message(make_test_frame(5), WireFormat{}, 41);
  message.images[0].metadata[0].value.assign(kMaxFrameBytes, 0);
  message.images[0].metadata[0].n = static_cast<std::int32_t>(kMaxFrameBytes);
  const std::vector<std::uint8_t> bytes = encode_message(message);
  EXPECT_THROW(read_frame_header(view_of(bytes)), InputError);
  EXPECT_THROW(decode_message<images_t>(view_of(bytes)), InputError);
}

}  // namespace
}  // namespace houghstream
