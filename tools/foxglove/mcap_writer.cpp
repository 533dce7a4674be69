#include "tools/foxglove/mcap_writer.hpp"

#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/zstd_bytes.hpp"

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "numbers are written as they lie in memory");

namespace houghstream::foxglove {
namespace {

// The kinds of records.
constexpr std::uint8_t kHeader = 0x01;
constexpr std::uint8_t kFooter = 0x02;
constexpr std::uint8_t kSchema = 0x03;
constexpr std::uint8_t kChannel = 0x04;
constexpr std::uint8_t kMessage = 0x05;
constexpr std::uint8_t kChunk = 0x06;
constexpr std::uint8_t kMessageIndex = 0x07;
constexpr std::uint8_t kChunkIndex = 0x08;
constexpr std::uint8_t kStatistics = 0x0B;
constexpr std::uint8_t kSummaryOffset = 0x0E;
constexpr std::uint8_t kDataEnd = 0x0F;

constexpr std::string_view kMagic("\x89MCAP0\r\n", 8);
constexpr std::size_t kChunkBytes = std::size_t{4} << 20U;  // before compression: some six frames with raw depth
constexpr int kCompressionLevel = 1;
const std::string kCompression = "zstd";

/// Appends numbers and texts as MCAP has them: little-endian, texts behind their lengths of four bytes.
class Fields {
 public:
  template <typename Number>
  Fields& number(Number value) {
    const std::size_t at = bytes_.size();
    bytes_.resize(at + sizeof value);
    std::memcpy(bytes_.data() + at, &value, sizeof value);
    return *this;
  }
  Fields& text(std::string_view value) {
    number(static_cast<std::uint32_t>(value.size()));
    bytes_.append(value);
    return *this;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// Returns a record: its kind, the length of its content, and the content, which is `fields` and then `rest`.
std::string record(std::uint8_t kind, const Fields& fields, std::string_view rest = {}) {
  Fields head;
  head.number(kind).number(static_cast<std::uint64_t>(fields.bytes().size() + rest.size()));
  std::string bytes = head.bytes() + fields.bytes();
  bytes.append(rest);
  return bytes;
}

std::uint32_t add_to_checksum(std::uint32_t checksum, std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(checksum, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<z_size_t>(bytes.size())));
}

}  // namespace

McapWriter::McapWriter(const std::filesystem::path& file)
    : whole_(file), out_(whole_.partial(), std::ios::binary | std::ios::trunc) {
  require(out_.good(), "{}: cannot be written: {}", whole_.partial().string(), std::strerror(errno));
  put(kMagic);
  put(record(kHeader, Fields().text("").text("houghstream")));  // profile, library
}

std::uint16_t McapWriter::add_channel(const McapChannel& channel) {
  require(channels_.size() < std::numeric_limits<std::uint16_t>::max(), "{}: topic {} is one of more than {}",
          whole_.file().string(), channel.topic, std::numeric_limits<std::uint16_t>::max());
  std::uint16_t& schema = schema_numbers_[channel.schema_name];
  if (schema == 0) {
    schema = static_cast<std::uint16_t>(schemas_.size() + 1);
    Fields fields;
    fields.number(schema).text(channel.schema_name).text(channel.schema_encoding).text(channel.schema);
    schemas_.push_back(record(kSchema, fields));
    chunk_ += schemas_.back();
  }
  const auto number = static_cast<std::uint16_t>(channels_.size());
  Fields fields;
  fields.number(number).number(schema).text(channel.topic).text(channel.message_encoding).text("");  // no metadata
  channels_.push_back(record(kChannel, fields));
  chunk_ += channels_.back();
  return number;
}

void McapWriter::write(std::uint16_t channel, const McapTimes& times, std::string_view data) {
  TimeIndex& index = index_[channel];
  if (index_.size() == 1 && index.empty()) chunk_start_ = chunk_end_ = times.log;
  chunk_start_ = std::min(chunk_start_, times.log);
  chunk_end_ = std::max(chunk_end_, times.log);
  index.emplace_back(times.log, chunk_.size());
  const auto sequence = static_cast<std::uint32_t>(counts_[channel]++);
  chunk_ += record(kMessage, Fields().number(channel).number(sequence).number(times.log).number(times.publish), data);
  if (chunk_.size() >= kChunkBytes) write_chunk();
}

void McapWriter::put(std::string_view bytes) {
  out_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  require(out_.good(), "{}: cannot be written: {}", whole_.partial().string(), std::strerror(errno));
  position_ += bytes.size();
  checksum_ = add_to_checksum(checksum_, bytes);
}

void McapWriter::write_chunk() {
  if (chunk_.empty()) return;
  const std::string compressed = compress_zstd(chunk_, kCompressionLevel);
  WrittenChunk chunk;
  chunk.start_time = chunk_start_;
  chunk.end_time = chunk_end_;
  chunk.offset = position_;
  chunk.compressed_size = compressed.size();
  chunk.uncompressed_size = chunk_.size();
  Fields fields;
  fields.number(chunk_start_).number(chunk_end_).number(static_cast<std::uint64_t>(chunk_.size()));
  fields.number(add_to_checksum(0, chunk_)).text(kCompression).number(static_cast<std::uint64_t>(compressed.size()));
  put(record(kChunk, fields, compressed));
  chunk.length = position_ - chunk.offset;
  write_indexes(chunk);
  written_.push_back(std::move(chunk));
  chunk_.clear();
  index_.clear();
  chunk_start_ = chunk_end_ = 0;
}

void McapWriter::write_indexes(WrittenChunk& chunk) {
  const std::uint64_t start = position_;
  for (auto& [channel, entries] : index_) {
    chunk.index_offsets[channel] = position_;
    std::stable_sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    Fields list;
    for (const auto& [time, offset] : entries) list.number(time).number(offset);
    put(record(kMessageIndex, Fields().number(channel).text(list.bytes())));
  }
  chunk.index_length = position_ - start;
}

std::string McapWriter::summary_of_chunk(const WrittenChunk& chunk) const {
  Fields offsets;
  for (const auto& [channel, offset] : chunk.index_offsets) offsets.number(channel).number(offset);
  Fields fields;
  fields.number(chunk.start_time).number(chunk.end_time).number(chunk.offset).number(chunk.length);
  fields.text(offsets.bytes()).number(chunk.index_length).text(kCompression);
  return record(kChunkIndex, fields.number(chunk.compressed_size).number(chunk.uncompressed_size));
}

std::string McapWriter::statistics() const {
  std::uint64_t messages = 0;
  Fields counts;
  for (const auto& [channel, count] : counts_) {
    messages += count;
    counts.number(channel).number(count);
  }
  std::uint64_t start = messages == 0 ? 0 : std::numeric_limits<std::uint64_t>::max();
  std::uint64_t end = 0;
  for (const WrittenChunk& chunk : written_) {
    if (chunk.index_offsets.empty()) continue;  // it holds no message
    start = std::min(start, chunk.start_time);
    end = std::max(end, chunk.end_time);
  }
  Fields fields;
  fields.number(messages).number(static_cast<std::uint16_t>(schemas_.size()));
  fields.number(static_cast<std::uint32_t>(channels_.size())).number(std::uint32_t{0}).number(std::uint32_t{0});
  fields.number(static_cast<std::uint32_t>(written_.size())).number(start).number(end).text(counts.bytes());
  return record(kStatistics, fields);
}

void McapWriter::write_summary() {
  struct Group {
    std::uint8_t kind;
    std::string records;
  };
  std::vector<Group> groups = {{kSchema, ""}, {kChannel, ""}, {kChunkIndex, ""}, {kStatistics, statistics()}};
  for (const std::string& schema : schemas_) groups[0].records += schema;
  for (const std::string& channel : channels_) groups[1].records += channel;
  for (const WrittenChunk& chunk : written_) groups[2].records += summary_of_chunk(chunk);
  const std::uint64_t start = position_;
  checksum_ = 0;  // of the summary alone
  std::string offsets;
  for (const Group& group : groups) {
    if (group.records.empty()) continue;
    Fields fields;
    fields.number(group.kind).number(position_).number(static_cast<std::uint64_t>(group.records.size()));
    offsets += record(kSummaryOffset, fields);
    put(group.records);
  }
  const std::uint64_t offset_start = position_;
  put(offsets);
  // The checksum covers the footer's first fields, which stand before it.
  const std::uint64_t length = 2 * sizeof(std::uint64_t) + sizeof(std::uint32_t);
  put(Fields().number(kFooter).number(length).number(start).number(offset_start).bytes());
  put(Fields().number(checksum_).bytes());
  put(kMagic);
}

void McapWriter::close() {
  write_chunk();
  put(record(kDataEnd, Fields().number(checksum_)));
  write_summary();
  out_.close();
  require(out_.good(), "{}: cannot be written: {}", whole_.partial().string(), std::strerror(errno));
  whole_.commit();
}

}  // namespace houghstream::foxglove
