#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pipeline/base/files.hpp"

namespace houghstream::foxglove {

/// Describes the stream of messages on one topic of a file.
struct McapChannel {
  std::string topic;
  std::string message_encoding;  ///< for instance "protobuf"
  std::string schema_name;       ///< for instance "foxglove.RawImage"
  std::string schema_encoding;   ///< for instance "protobuf"
  std::string schema;            ///< its definition in this encoding
};

/// Times of a message, nanoseconds since the epoch.
struct McapTimes {
  std::uint64_t log = 0;      ///< when it was recorded: readers play messages in this order
  std::uint64_t publish = 0;  ///< when it was published
};

/// Writes a file in MCAP format (https://mcap.dev/spec, version 0): chunks compressed with zstd, each with a checksum
/// and an index by time and channel, and a summary with which readers seek. The file is there as a whole once it is
/// closed (AtomicFile), and not at all where it is not. Not thread-safe.
class McapWriter {
 public:
  /// Throws InputError when the file cannot be made.
  explicit McapWriter(const std::filesystem::path& file);

  /// Adds a channel and returns its number. Channels of the same schema share it by its name. Throws InputError for one
  /// more than 65,535.
  std::uint16_t add_channel(const McapChannel& channel);

  /// Writes a message of a channel. Throws InputError when the disk refuses.
  void write(std::uint16_t channel, const McapTimes& times, std::string_view data);

  /// Writes the summary, checks that everything arrived in the file and puts it into its place. Throws InputError.
  void close();

 private:
  /// A chunk that is written, as the summary describes it.
  struct WrittenChunk {
    std::uint64_t start_time = 0;
    std::uint64_t end_time = 0;
    std::uint64_t offset = 0;
    std::uint64_t length = 0;
    std::map<std::uint16_t, std::uint64_t> index_offsets;  // by channel
    std::uint64_t index_length = 0;
    std::uint64_t compressed_size = 0;
    std::uint64_t uncompressed_size = 0;
  };
  using TimeIndex = std::vector<std::pair<std::uint64_t, std::uint64_t>>;  // time and offset in the chunk

  void put(std::string_view bytes);
  void write_chunk();
  void write_indexes(WrittenChunk& chunk);
  std::string summary_of_chunk(const WrittenChunk& chunk) const;
  std::string statistics() const;
  void write_summary();

  AtomicFile whole_;
  std::ofstream out_;
  std::uint64_t position_ = 0;
  std::uint32_t checksum_ = 0;         // of all bytes so far
  std::vector<std::string> schemas_;   // records, by number from 1
  std::vector<std::string> channels_;  // records, by number from 0
  std::map<std::string, std::uint16_t> schema_numbers_;
  std::string chunk_;  // records that wait to be compressed
  std::uint64_t chunk_start_ = 0;
  std::uint64_t chunk_end_ = 0;
  std::map<std::uint16_t, TimeIndex> index_;  // of the messages in it
  std::vector<WrittenChunk> written_;
  std::map<std::uint16_t, std::uint64_t> counts_;  // messages by channel
};

}  // namespace houghstream::foxglove
