#include "drivers/ros_bag/bag_file.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/drivers/ros_bag/test_bag.hpp"
#include "tests/expect_says.hpp"
#include "tests/test_files.hpp"

namespace houghstream::ros_bag {
namespace {

namespace fs = std::filesystem;

fs::path save_bytes(const std::string& name, const Bytes& bytes) {
  fs::path file = fresh_folder("bag_file_" + name) / "take.bag";
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  return file;
}

Bytes random_bytes(std::size_t size, unsigned seed) {
  std::mt19937 random(seed);
  Bytes bytes(size);
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random() % 4);
  return bytes;
}

/// Writes twelve messages on /a and /b in three chunks.
Bytes small_bag(const std::string& compression, bool is_indexed = true) {
  TestBag bag(compression);
  for (unsigned i = 0; i < 12; ++i) {
    bag.add(i % 2 == 0 ? "/a" : "/b", "test/Data", random_bytes(100 * i, i), 1'000'000 + 1000 * i);
    if (i % 4 == 3) bag.end_chunk();
  }
  return bag.bytes(is_indexed);
}

std::string refusal(const std::string& name, const Bytes& bytes) {
  const fs::path file = save_bytes(name, bytes);
  return error_of([&] {
    BagFile bag(file);
    BagMessages messages(bag, {0, 1});
    while (messages.next()) continue;
  });
}

void replace(Bytes& bytes, const std::string& from, const std::string& to) {
  const auto at = std::search(bytes.begin(), bytes.end(), from.begin(), from.end());
  ASSERT_NE(at, bytes.end()) << from;
  std::copy(to.begin(), to.end(), at);
}

TEST(BagFile, MessagesComeBackBitByBitOfEachCompression) {
  for (const std::string compression : {"none", "bz2", "lz4"}) {
    BagFile bag(save_bytes(compression, small_bag(compression)));
    ASSERT_EQ(bag.connections().size(), 2U);
    EXPECT_EQ(bag.connections()[1].topic, "/b");
    EXPECT_EQ(bag.connections()[1].type, "test/Data");
    BagMessages messages(bag, {0, 1});
    for (unsigned i = 0; i < 12; ++i) {
      const std::optional<BagMessage> message = messages.next();
      ASSERT_TRUE(message.has_value()) << compression << i;
      EXPECT_EQ(message->connection, i % 2);
      EXPECT_EQ(message->received_ns, 1'000'000'000 + 1'000'000 * i);
      EXPECT_EQ(message->bytes, random_bytes(100 * i, i)) << compression << i;
    }
    EXPECT_FALSE(messages.next().has_value());
  }
}

TEST(BagFile, MessagesOfOneTopicComeAlone) {
  BagFile bag(save_bytes("one", small_bag("lz4")));
  BagMessages messages(bag, {1});
  int count = 0;
  while (const std::optional<BagMessage> message = messages.next()) {
    EXPECT_EQ(message->connection, 1U);
    ++count;
  }
  EXPECT_EQ(count, 6);
}

TEST(BagFile, ChunksWhoseTimesOverlapAreMergedByTime) {
  TestBag bag;
  for (const int first : {0, 1}) {  // one topic after the other
    for (int i = first; i < 20; i += 2) {
      bag.add(first == 0 ? "/a" : "/b", "test/Data", {static_cast<std::uint8_t>(i)}, 1000 * i);
      if (i % 6 == 5) bag.end_chunk();
    }
    bag.end_chunk();
  }
  BagFile file(save_bytes("overlap", bag.bytes()));
  BagMessages messages(file, {0, 1});
  for (int i = 0; i < 20; ++i) EXPECT_EQ(messages.next()->bytes, Bytes{static_cast<std::uint8_t>(i)});
  EXPECT_FALSE(messages.next().has_value());
}

TEST(BagFile, WhatIsNoBagIsRefused) {
  expect_says(error_of([] { BagFile bag("/no/such.bag"); }), {"/no/such.bag", "a ROS bag"});
  expect_says(refusal("text", {'h', 'e', 'l', 'l', 'o'}), {"take.bag", "is no ROS bag", "#ROSBAG V2.0"});
  expect_says(refusal("empty", {}), {"take.bag", "is no ROS bag"});
  Bytes old = small_bag("none");
  replace(old, "V2.0", "V1.2");
  expect_says(refusal("old", old), {"take.bag", "#ROSBAG V1.2", "expected #ROSBAG V2.0"});
  expect_says(refusal("active", small_bag("none", false)), {"take.bag", "has no index", "rosbag reindex"});
}

TEST(BagFile, ACutBagIsRefusedWhereverItEnds) {
  for (const std::string compression : {"none", "bz2", "lz4"}) {
    const Bytes whole = small_bag(compression);
    for (std::size_t size = 0; size < whole.size(); size += 1 + whole.size() / 60) {
      const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
      expect_says(refusal("cut", cut), {"take.bag"});
    }
  }
}

TEST(BagFile, DamageIsRefusedInOneLine) {
  Bytes unknown = small_bag("lz4");
  replace(unknown, "compression=lz4", "compression=xz4");
  expect_says(refusal("unknown", unknown), {"take.bag, chunk at byte 4117", "'xz4'", "none, bz2 or lz4"});
  for (const std::string compression : {"bz2", "lz4"}) {
    Bytes broken = small_bag("none");
    replace(broken, "compression=none", "compression=" + compression + ' ');
    Bytes plain = small_bag(compression);
    plain[4117 + 4 + 60] ^= 0xFFU;  // in the first compressed bytes
    expect_says(refusal("broken", plain), {"take.bag, chunk at byte 4117", "expected"});
  }
  Bytes miscounted = small_bag("none");
  const std::string message = std::string("conn=") + '\1' + std::string(3, '\0') + '\x09';
  const auto at = std::search(miscounted.begin() + 4400, miscounted.end(), message.begin(), message.begin() + 9);
  ASSERT_NE(at, miscounted.end());
  *(at + 5) = 0;  // a message of the other connection
  expect_says(refusal("miscounted", miscounted), {"take.bag", "damaged"});
}

TEST(BagFile, AStatedSizeTakesNoMemory) {
  Bytes huge = small_bag("lz4");
  const std::string size = "size=";
  const auto at = std::search(huge.begin(), huge.end(), size.begin(), size.end());
  *(at + 8) = 0xFF;
  expect_says(refusal("huge", huge), {"take.bag, chunk at byte 4117", "expected at most"});
  *(at + 8) = 0x1F;  // half a gigabyte, of which nothing is there
  expect_says(refusal("large", huge), {"take.bag, chunk at byte 4117", "that it states"});
}

}  // namespace
}  // namespace houghstream::ros_bag
