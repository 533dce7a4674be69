#include "tools/foxglove/mcap_writer.hpp"

#include <gtest/gtest.h>
#include <zlib.h>
#include <zstd.h>

#include <cstring>

#include "pipeline/base/checks.hpp"
#include "tests/test_files.hpp"

namespace houghstream::foxglove {
namespace {

namespace fs = std::filesystem;

template <typename Number>
Number number_at(const std::string& bytes, std::size_t at) {
  Number value{};
  std::memcpy(&value, bytes.substr(at, sizeof value).data(), sizeof value);
  return value;
}

struct Record {
  std::size_t at = 0;
  int kind = 0;
  std::string content;
};

/// Splits bytes into records; the last one must end where they do.
std::vector<Record> split_records(const std::string& bytes) {
  std::vector<Record> records;
  for (std::size_t at = 0; at < bytes.size();) {
    Record record;
    record.at = at;
    record.kind = static_cast<unsigned char>(bytes[at]);
    record.content = bytes.substr(at + 9, number_at<std::uint64_t>(bytes, at + 1));
    at += 9 + record.content.size();
    records.push_back(record);
  }
  return records;
}

std::uint32_t checksum(const std::string& bytes) {
  return static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

/// Returns the records of a chunk: kind 6 has four numbers, the checksum, the word "zstd" and the compressed bytes.
std::string unpacked(const std::string& chunk) {
  EXPECT_EQ(chunk.substr(32, 4), "zstd");
  const std::string compressed = chunk.substr(44);
  EXPECT_EQ(number_at<std::uint64_t>(chunk, 36), compressed.size());
  std::string bytes(number_at<std::uint64_t>(chunk, 16), '\0');
  EXPECT_EQ(ZSTD_decompress(bytes.data(), bytes.size(), compressed.data(), compressed.size()), bytes.size());
  EXPECT_EQ(checksum(bytes), number_at<std::uint32_t>(chunk, 24));
  return bytes;
}

McapChannel channel_of(const std::string& topic) {
  McapChannel channel;
  channel.topic = topic;
  channel.message_encoding = "json";
  channel.schema_name = "point";
  channel.schema_encoding = "jsonschema";
  channel.schema = "{}";
  return channel;
}

std::string magic() {
  return {"\x89MCAP0\r\n", 8};
}

/// Two channels, three messages, of which the last one is the earliest.
std::string written_file(const fs::path& file) {
  McapWriter writer(file);
  const std::uint16_t left = writer.add_channel(channel_of("/left"));
  const std::uint16_t right = writer.add_channel(channel_of("/right"));
  writer.write(left, {2000, 1}, "two");
  writer.write(right, {3000, 2}, "three");
  writer.write(left, {1000, 3}, "one");
  EXPECT_FALSE(fs::exists(file)) << "it is not whole";
  writer.close();
  return read_text(file);
}

TEST(McapWriter, HasHeaderChunkIndexesSummaryAndFooter) {
  const std::string file = written_file(fresh_folder("mcap_structure") / "out.mcap");
  ASSERT_EQ(file.substr(0, 8), magic());
  ASSERT_EQ(file.substr(file.size() - 8), magic());
  const std::vector<Record> records = split_records(file.substr(8, file.size() - 16));
  std::vector<int> kinds;
  for (const Record& record : records) kinds.push_back(record.kind);
  // Header, chunk, two indexes, end of the data; schema, two channels, chunk index, statistics, their offsets, footer.
  EXPECT_EQ(kinds, (std::vector<int>{1, 6, 7, 7, 15, 3, 4, 4, 8, 11, 14, 14, 14, 14, 2}));
  EXPECT_EQ(records[0].content, std::string("\0\0\0\0\x0b\0\0\0houghstream", 19));
}

TEST(McapWriter, HasChecksumsOfDataAndSummary) {
  const std::string file = written_file(fresh_folder("mcap_checksums") / "out.mcap");
  const std::vector<Record> records = split_records(file.substr(8, file.size() - 16));
  EXPECT_EQ(number_at<std::uint32_t>(records[4].content, 0), checksum(file.substr(0, 8 + records[4].at)));
  const std::string& footer = records.back().content;
  const auto start = number_at<std::uint64_t>(footer, 0);
  EXPECT_EQ(start, 8 + records[5].at);
  EXPECT_EQ(number_at<std::uint64_t>(footer, 8), 8 + records[10].at) << "where the offsets begin";
  const std::size_t end = file.size() - 8 - 4;
  EXPECT_EQ(number_at<std::uint32_t>(footer, 16), checksum(file.substr(start, end - start)));
}

TEST(McapWriter, FindsMessagesByTime) {
  const std::string file = written_file(fresh_folder("mcap_index") / "out.mcap");
  const std::vector<Record> records = split_records(file.substr(8, file.size() - 16));
  const std::string chunk = unpacked(records[1].content);
  EXPECT_EQ(number_at<std::uint64_t>(records[1].content, 0), 1000U);
  EXPECT_EQ(number_at<std::uint64_t>(records[1].content, 8), 3000U);
  const std::string& left = records[2].content;  // channel, size of the list, then times and offsets
  EXPECT_EQ(number_at<std::uint16_t>(left, 0), 0);
  EXPECT_EQ(number_at<std::uint32_t>(left, 2), 32U);
  EXPECT_EQ(number_at<std::uint64_t>(left, 6), 1000U);
  const std::vector<Record> first = split_records(chunk.substr(number_at<std::uint64_t>(left, 14)));
  EXPECT_EQ(first[0].kind, 5);
  EXPECT_EQ(first[0].content.substr(22), "one");
  EXPECT_EQ(number_at<std::uint32_t>(first[0].content, 2), 1U) << "the second message of its channel";
  EXPECT_EQ(number_at<std::uint64_t>(first[0].content, 14), 3U) << "its time of publishing";
  const std::string& index = records[8].content;
  EXPECT_EQ(number_at<std::uint64_t>(index, 16), 8 + records[1].at);
  EXPECT_EQ(number_at<std::uint64_t>(index, 38), 8 + records[2].at) << "of the first channel's index";
}

TEST(McapWriter, CountsMessages) {
  const std::string file = written_file(fresh_folder("mcap_statistics") / "out.mcap");
  const std::vector<Record> records = split_records(file.substr(8, file.size() - 16));
  const std::string& statistics = records[9].content;
  EXPECT_EQ(number_at<std::uint64_t>(statistics, 0), 3U);
  EXPECT_EQ(number_at<std::uint16_t>(statistics, 8), 1) << "schemas";
  EXPECT_EQ(number_at<std::uint32_t>(statistics, 10), 2U) << "channels";
  EXPECT_EQ(number_at<std::uint32_t>(statistics, 22), 1U) << "chunks";
  EXPECT_EQ(number_at<std::uint64_t>(statistics, 26), 1000U);
  EXPECT_EQ(number_at<std::uint64_t>(statistics, 34), 3000U);
  EXPECT_EQ(number_at<std::uint64_t>(statistics, 48), 2U) << "messages of the first channel";
}

TEST(McapWriter, BeginsAnotherChunkWhenOneIsFull) {
  const fs::path file = fresh_folder("mcap_chunks") / "out.mcap";
  McapWriter writer(file);
  const std::uint16_t channel = writer.add_channel(channel_of("/large"));
  const std::string data(std::size_t{3} << 20U, 'x');
  for (std::uint64_t i = 0; i < 5; ++i) writer.write(channel, {i, i}, data);
  writer.close();
  const std::string bytes = read_text(file);
  int chunks = 0;
  std::size_t messages = 0;
  for (const Record& record : split_records(bytes.substr(8, bytes.size() - 16))) {
    if (record.kind != 6) continue;
    ++chunks;
    for (const Record& inner : split_records(unpacked(record.content))) messages += inner.kind == 5 ? 1 : 0;
  }
  EXPECT_EQ(chunks, 3);
  EXPECT_EQ(messages, 5U);
}

TEST(McapWriter, LeavesNothingWhereItIsNotClosed) {
  const fs::path folder = fresh_folder("mcap_unclosed");
  {
    McapWriter writer(folder / "out.mcap");
    writer.write(writer.add_channel(channel_of("/left")), {1, 1}, "one");
  }
  EXPECT_TRUE(fs::is_empty(folder));
}

TEST(McapWriter, SaysThatTheDiskIsFull) {
  McapWriter writer("/dev/full");
  writer.write(writer.add_channel(channel_of("/left")), {1, 1}, "one");
  EXPECT_NE(error_of([&] { writer.close(); }).find("/dev/full: cannot be written: No space left"), std::string::npos);
}

}  // namespace
}  // namespace houghstream::foxglove
