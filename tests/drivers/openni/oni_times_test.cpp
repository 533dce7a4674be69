#include "drivers/openni/oni_times.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "pipeline/base/checks.hpp"
#include "tests/test_files.hpp"

namespace houghstream::openni {
namespace {

/// A recording of two streams with two images each, as OpenNI2 writes them.
class TinyOni {
 public:
  TinyOni() {
    append(std::string("NI10\1\0\1\0\0\0\0\0", 12));
    append(std::string(12, '\xFF'));
    for (const std::uint32_t node : {1U, 2U}) add_node(node);
    for (const std::uint64_t time : {0ULL, 33'333ULL}) {
      for (const std::uint32_t node : {1U, 2U}) add_image(node, time);
    }
    for (const std::uint32_t node : {1U, 2U}) add_seek_table(node);
    add_record(11, 0, {}, {});
  }
  const std::string& bytes() const { return bytes_; }
  std::uint64_t at(std::size_t place) const {
    std::uint64_t value = 0;
    std::memcpy(&value, bytes_.data() + place, sizeof(value));
    return value;
  }
  /// Records of a node: its range, its images and their entries in the seek table.
  const std::vector<std::size_t>& times(std::uint32_t node) const { return times_[node]; }

 private:
  template <typename T>
  static std::string raw(T value) {
    return {reinterpret_cast<const char*>(&value), sizeof(value)};
  }
  void append(const std::string& bytes) { bytes_ += bytes; }
  void add_record(std::uint32_t type, std::uint32_t node, const std::string& fields, const std::string& payload) {
    append(raw(0x0052494EU) + raw(type) + raw(node) + raw(static_cast<std::uint32_t>(28 + fields.size())) +
           raw(static_cast<std::uint32_t>(payload.size())) + raw(std::uint64_t{0}) + fields + payload);
  }
  void add_node(std::uint32_t node) {
    const std::string name = raw(6U) + std::string("Depth\0", 6) + raw(2U) + raw(7U) + raw(2U);
    times_[node] = {bytes_.size() + 28 + name.size(), bytes_.size() + 28 + name.size() + 8};
    add_record(13, node, name + raw(std::uint64_t{0}) + raw(std::uint64_t{33'333}) + raw(std::uint64_t{99}), {});
  }
  void add_image(std::uint32_t node, std::uint64_t time) {
    times_[node].push_back(bytes_.size() + 28);
    add_record(10, node, raw(time) + raw(0U) + raw(1U), "picture");
  }
  void add_seek_table(std::uint32_t node) {
    for (const int entry : {1, 2}) times_[node].push_back(bytes_.size() + 28 + 20 * static_cast<std::size_t>(entry));
    std::string table(20, '\0');
    for (const std::uint64_t time : {0ULL, 33'333ULL}) table += raw(time) + raw(0U) + raw(std::uint64_t{77});
    add_record(14, node, {}, table);
  }

  std::string bytes_;
  std::vector<std::size_t> times_[3];
};

class OniTimes : public ::testing::Test {
 protected:
  OniTimes() : folder(fresh_folder("oni_times")), file(folder / "a.oni") {}
  ~OniTimes() override { std::filesystem::remove_all(folder); }

  void expect_refused(const std::string& bytes, const std::string& words) {
    write_text(file, bytes);
    const std::string error = error_of([&] { delay_oni_node(file, OniNode::kFirst, 5); });
    EXPECT_NE(error.find(words), std::string::npos) << error;
    EXPECT_EQ(read_text(file), bytes) << "left as it was";
  }

  std::filesystem::path folder;
  std::filesystem::path file;
};

TEST_F(OniTimes, OneStreamsTimesAreLaterAndNothingElseIsChanged) {
  const TinyOni tiny;
  for (const std::uint32_t node : {1U, 2U}) {
    write_text(file, tiny.bytes());
    delay_oni_node(file, static_cast<OniNode>(node), 8000);
    std::string expected = tiny.bytes();
    for (const std::size_t place : tiny.times(node)) {
      const std::uint64_t time = tiny.at(place) + 8000;
      std::memcpy(expected.data() + place, &time, sizeof(time));
    }
    EXPECT_EQ(read_text(file), expected) << node;
  }
}

TEST_F(OniTimes, WhatIsNoWholeRecordingIsRefusedAndLeftAsItWas) {
  const std::string whole = TinyOni().bytes();
  expect_refused("no recording", "no recording of OpenNI2's");
  expect_refused("", "no recording of OpenNI2's");
  for (std::size_t size = 12; size < whole.size() - 28; size += 11) expect_refused(whole.substr(0, size), "a.oni");
  std::string other = whole;
  other[6] = 2;
  expect_refused(other, "version 1.0.1");
  std::string broken = whole;
  broken[24] = 'X';
  expect_refused(broken, "no record at byte 24");
  write_text(file, whole);
  EXPECT_THROW(delay_oni_node(file, OniNode::kFirst, -1), InputError);
  EXPECT_THROW(delay_oni_node(folder / "none.oni", OniNode::kFirst, 1), InputError);
}

TEST_F(OniTimes, ARecordingThatStatesMoreThanItHoldsIsRefused) {
  const TinyOni oni;
  write_text(file, oni.bytes());
  EXPECT_NO_THROW(check_oni(file));
  std::string many = oni.bytes();
  const std::size_t images = many.find("Depth") + 6 + 8;  // behind type and codec
  many.replace(images, 4, std::string("\0\0\0\x04", 4));
  write_text(file, many);
  EXPECT_THROW(check_oni(file), InputError) << "67 million images";
  write_text(file, oni.bytes().substr(0, oni.bytes().size() - 30));
  EXPECT_THROW(check_oni(file), InputError) << "cut";
}

// OpenNI2 plays as many images as a stream states, up to the first record that is an end.
TEST_F(OniTimes, NoFlippedBitLeavesImagesOutWithoutAWord) {
  const std::string whole = TinyOni().bytes();
  write_text(file, whole);
  ASSERT_EQ(check_oni(file), 4U);
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    std::string bytes = whole;
    bytes[bit / 8] ^= static_cast<char>(1U << bit % 8);
    write_text(file, bytes);
    const std::string error = error_of([&] { EXPECT_EQ(check_oni(file), 4U) << "bit " << bit; });
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  }
}

TEST_F(OniTimes, AnImageThatIsNotWhereItsTableSaysIsRefused) {
  const TinyOni oni;
  std::string bytes = oni.bytes();
  bytes[oni.times(2).at(3)] ^= 1;  // a bit of its second image
  write_text(file, bytes);
  EXPECT_NE(error_of([&] { check_oni(file); }).find("stream 2 are not at the times"), std::string::npos);
  write_text(file, oni.bytes() + "room");
  EXPECT_EQ(check_oni(file), 4U) << "OpenNI2 leaves room behind the end";
}

}  // namespace
}  // namespace houghstream::openni
