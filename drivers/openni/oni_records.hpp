#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"

// The records of a .oni file as OpenNI2 writes them (its DataRecords.h), little endian: a file header, then records of
// a header, fields and a payload. Included by the .cpp files of this folder only.

namespace houghstream::openni {

inline constexpr std::array<char, 12> kOniFileStart = {'N', 'I', '1', '0', 1, 0, 1, 0, 0, 0, 0, 0};
inline constexpr std::uint64_t kOniFileHeader = 24;    // start, latest time, largest number of a stream
inline constexpr std::uint64_t kOniRecordHeader = 28;  // counted among a record's fields
inline constexpr std::uint32_t kOniMagic = 0x0052494E;
inline constexpr std::uint64_t kOniSeekEntry = 20;  // time, configuration, position
// Before the end of a node's fields: first time, last time, seek table.
inline constexpr std::uint64_t kOniRangeEnd = 24;
inline constexpr std::uint64_t kOniImages = kOniRangeEnd + 4;  // likewise: their number, before the first time

enum class OniRecordType : std::uint32_t {
  kNodeRemoved = 7,
  kNewData = 10,
  kEnd = 11,
  kNodeAdded = 13,
  kSeekTable = 14
};

struct OniRecordHeader {
  std::uint32_t type = 0;
  std::uint32_t node = 0;
  std::uint64_t fields = 0;
  std::uint64_t payload = 0;

  bool is(OniRecordType other) const { return type == static_cast<std::uint32_t>(other); }
};

/// Reads a file of such records. Throws InputError where it holds anything else.
class OniFile {
 public:
  explicit OniFile(const std::filesystem::path& file, std::ios::openmode mode = std::ios::in) : name_(file.string()) {
    require_regular_file(file, "a recording of OpenNI2's");
    size_ = std::filesystem::file_size(file);
    stream_.open(file, mode | std::ios::binary);
    std::array<char, kOniFileStart.size()> start{};
    stream_.read(start.data(), start.size());
    require(stream_ && start == kOniFileStart, "{}: no recording of OpenNI2's, version 1.0.1", name_);
  }

  template <typename T>
  T read(std::uint64_t at) {
    T value{};
    stream_.clear();  // an earlier place may have been behind the end
    stream_.seekg(static_cast<std::streamoff>(at));
    stream_.read(reinterpret_cast<char*>(&value), sizeof(value));
    require(stream_.good(), "{}: ends before byte {}, expected a whole recording (hs-log repair ends a cut one)", name_,
            at + sizeof(value));
    return value;
  }

  OniRecordHeader record(std::uint64_t at) {
    const auto words = read<std::array<std::uint32_t, 5>>(at);
    require(words[0] == kOniMagic && words[3] >= kOniRecordHeader, "{}: no record at byte {}", name_, at);
    const OniRecordHeader header{words[1], words[2], words[3], words[4]};
    require(header.fields + header.payload <= size_ - at, "{}: cut in the record at byte {}", name_, at);
    return header;
  }

  std::uint64_t size() const { return size_; }
  const std::string& name() const { return name_; }

  template <typename T>
  void write(std::uint64_t at, const T& value) {
    stream_.seekp(static_cast<std::streamoff>(at));
    stream_.write(reinterpret_cast<const char*>(&value), sizeof(value));
  }

  void flush() {
    stream_.flush();
    require(stream_.good(), "{}: cannot be written", name_);
  }

 private:
  std::string name_;
  std::uint64_t size_ = 0;
  std::fstream stream_;
};

}  // namespace houghstream::openni
