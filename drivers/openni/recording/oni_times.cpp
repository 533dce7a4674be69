#include "drivers/openni/recording/oni_times.hpp"

#include <array>
#include <fstream>
#include <map>
#include <vector>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"

namespace houghstream::openni {
namespace {

// The format, little endian: a file header, then records of a header, fields and a payload (OpenNI2's DataRecords.h).
constexpr std::array<char, 12> kFileStart = {'N', 'I', '1', '0', 1, 0, 1, 0, 0, 0, 0, 0};
constexpr std::uint64_t kFileHeader = 24;
constexpr std::uint64_t kRecordHeader = 28;  // counted among a record's fields
constexpr std::uint32_t kMagic = 0x0052494E;
constexpr std::uint64_t kSeekEntry = 20;  // time, configuration, position
constexpr std::uint64_t kRangeEnd = 24;   // before the end of a node's fields: first time, last time, seek table

constexpr std::uint64_t kImages = kRangeEnd + 4;  // likewise: their number, before the first time

enum class Type : std::uint32_t { kNewData = 10, kEnd = 11, kNodeAdded = 13, kSeekTable = 14 };

struct RecordHeader {
  std::uint32_t type = 0;
  std::uint32_t node = 0;
  std::uint64_t fields = 0;
  std::uint64_t payload = 0;
};

class OniFile {
 public:
  explicit OniFile(const std::filesystem::path& file, std::ios::openmode mode = std::ios::in) : name_(file.string()) {
    require_regular_file(file, "a recording of OpenNI2's");
    size_ = std::filesystem::file_size(file);
    stream_.open(file, mode | std::ios::binary);
    std::array<char, kFileStart.size()> start{};
    stream_.read(start.data(), start.size());
    require(stream_ && start == kFileStart, "{}: no recording of OpenNI2's, version 1.0.1", name_);
  }

  template <typename T>
  T read(std::uint64_t at) {
    T value{};
    stream_.seekg(static_cast<std::streamoff>(at));
    stream_.read(reinterpret_cast<char*>(&value), sizeof(value));
    require(stream_.good(), "{}: ends before byte {}, expected a whole recording", name_, at + sizeof(value));
    return value;
  }

  RecordHeader record(std::uint64_t at) {
    const auto words = read<std::array<std::uint32_t, 5>>(at);
    require(words[0] == kMagic && words[3] >= kRecordHeader, "{}: no record at byte {}", name_, at);
    const RecordHeader header{words[1], words[2], words[3], words[4]};
    require(header.fields + header.payload <= size_ - at, "{}: cut in the record at byte {}", name_, at);
    return header;
  }

  std::uint64_t size() const { return size_; }
  const std::string& name() const { return name_; }

  void add(const std::vector<std::uint64_t>& places, std::uint64_t amount) {
    for (const std::uint64_t at : places) {
      const std::uint64_t value = read<std::uint64_t>(at) + amount;
      stream_.seekp(static_cast<std::streamoff>(at));
      stream_.write(reinterpret_cast<const char*>(&value), sizeof(value));
    }
    stream_.flush();
    require(stream_.good(), "{}: cannot be written", name_);
  }

 private:
  std::string name_;
  std::uint64_t size_ = 0;
  std::fstream stream_;
};

/// Where a record at `at` holds times.
std::vector<std::uint64_t> times_in(const RecordHeader& record, std::uint64_t at) {
  const std::uint64_t payload = at + record.fields;
  switch (static_cast<Type>(record.type)) {
    case Type::kNewData: return {at + kRecordHeader};
    case Type::kNodeAdded: return {payload - kRangeEnd, payload - kRangeEnd + sizeof(std::uint64_t)};
    case Type::kSeekTable: break;
    default: return {};
  }
  std::vector<std::uint64_t> places;  // the first entry stands for no image
  for (std::uint64_t entry = kSeekEntry; entry + kSeekEntry <= record.payload; entry += kSeekEntry) {
    places.push_back(payload + entry);
  }
  return places;
}

/// What a stream states, and what there is of it.
struct StreamContent {
  std::uint32_t stated = 0;             // images
  std::vector<std::uint64_t> times;     // of its images
  std::vector<std::uint64_t> in_table;  // likewise, of its seek table
};

void note_record(OniFile& oni, const RecordHeader& record, std::uint64_t at, StreamContent& stream) {
  const auto type = static_cast<Type>(record.type);
  const std::uint64_t least = kRecordHeader + (type == Type::kNodeAdded ? kImages : sizeof(std::uint64_t));
  require(record.fields >= least || (type != Type::kNodeAdded && type != Type::kNewData),
          "{}: a record of {} bytes at byte {}, expected {} or more", oni.name(), record.fields, at, least);
  if (type == Type::kNodeAdded) stream.stated = oni.read<std::uint32_t>(at + record.fields - kImages);
  if (type == Type::kNewData) stream.times.push_back(oni.read<std::uint64_t>(times_in(record, at).front()));
  if (type != Type::kSeekTable) return;
  for (const std::uint64_t place : times_in(record, at)) stream.in_table.push_back(oni.read<std::uint64_t>(place));
}

}  // namespace

std::size_t check_oni(const std::filesystem::path& file) {
  OniFile oni(file);
  std::map<std::uint32_t, StreamContent> streams;
  std::uint64_t at = kFileHeader;
  RecordHeader record = oni.record(at);
  for (; static_cast<Type>(record.type) != Type::kEnd; record = oni.record(at)) {
    note_record(oni, record, at, streams[record.node]);
    at += record.fields + record.payload;
  }
  std::size_t images = 0;
  for (const auto& [node, stream] : streams) {
    require(stream.times.size() == stream.stated, "{}: stream {} states {} images, {} are there", oni.name(), node,
            stream.stated, stream.times.size());
    require(stream.in_table.empty() || stream.in_table == stream.times,
            "{}: the images of stream {} are not at the times of its seek table", oni.name(), node);
    images += stream.times.size();
  }
  return images;
}

void delay_oni_node(const std::filesystem::path& file, OniNode node, std::int64_t delay_us) {
  require(delay_us >= 0, "{}: a delay of {} us, expected none or more", file.string(), delay_us);
  OniFile oni(file, std::ios::in | std::ios::out);
  std::vector<std::uint64_t> places;
  std::uint64_t at = kFileHeader;
  for (RecordHeader record = oni.record(at); static_cast<Type>(record.type) != Type::kEnd; record = oni.record(at)) {
    if (record.node == static_cast<std::uint32_t>(node)) {
      const std::vector<std::uint64_t> found = times_in(record, at);
      places.insert(places.end(), found.begin(), found.end());
    }
    at += record.fields + record.payload;
  }
  oni.add(places, static_cast<std::uint64_t>(delay_us));
}

}  // namespace houghstream::openni
