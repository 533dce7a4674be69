#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "drivers/ros_bag/byte_reader.hpp"

namespace houghstream::ros_bag {

/// Describes one publisher of a topic.
struct BagConnection {
  std::uint32_t id = 0;
  std::string topic;
  std::string type;  ///< for instance "sensor_msgs/Image"
};

/// Holds a message as it was published.
struct BagMessage {
  std::uint32_t connection = 0;
  std::int64_t received_ns = 0;  ///< when it was recorded, nanoseconds since the epoch
  std::vector<std::uint8_t> bytes;

  ByteRange range() const { return {bytes.data(), bytes.size()}; }
};

/// Describes a chunk of messages as the index states it.
struct BagChunk {
  std::uint64_t position = 0;
  std::int64_t start_ns = 0;
  std::map<std::uint32_t, std::uint32_t> counts;  ///< messages of each connection
};

/// Reads a ROS 1 bag of version 2.0 (wiki.ros.org/Bags/Format/2.0): opened, its index is in memory; chunks are read one
/// by one. Every count and length is checked before it is used, and the index against the chunks. ROS's own library is
/// not linked: it reserves what a damaged length states and ends the process where that is not there, and opening a bag
/// looks through /usr/share for plug-ins. Not thread-safe.
class BagFile {
 public:
  /// Throws InputError where the file is no bag, of another version, encrypted, cut, damaged, or has no index, as one
  /// whose recorder was killed.
  explicit BagFile(const std::filesystem::path& file);

  const std::string& name() const { return name_; }
  const std::vector<BagConnection>& connections() const { return connections_; }
  /// Returns the chunks in the order of their first messages.
  const std::vector<BagChunk>& chunks() const { return chunks_; }

  /// Returns the chunk's messages of these connections in the file's order. Throws InputError where it is damaged, or
  /// does not hold what the index states.
  std::vector<BagMessage> read_chunk(const BagChunk& chunk, const std::set<std::uint32_t>& connections);

 private:
  std::vector<std::uint8_t> read_at(std::uint64_t position, std::uint64_t size, const char* what);
  void read_index(std::uint64_t position, std::uint32_t connections, std::uint32_t chunks);

  std::string name_;
  std::ifstream in_;
  std::uint64_t size_ = 0;
  std::vector<BagConnection> connections_;
  std::vector<BagChunk> chunks_;
};

/// Walks through the messages of some connections in the order in which they were received. Chunks are read when their
/// turn comes: in memory are those whose times overlap. Not thread-safe.
class BagMessages {
 public:
  /// The file must outlive it.
  BagMessages(BagFile& file, std::set<std::uint32_t> connections);

  /// Returns the next message, or nothing at the end. Throws InputError where the file is damaged, or more than 1 GB of
  /// messages would have to be held at once to put them in order.
  std::optional<BagMessage> next();

 private:
  void read_chunk();

  BagFile& file_;
  std::set<std::uint32_t> connections_;
  std::vector<const BagChunk*> chunks_;  // those that hold wanted messages
  std::size_t next_chunk_ = 0;
  std::multimap<std::int64_t, BagMessage> waiting_;  // by time of reception
  std::size_t waiting_bytes_ = 0;
};

}  // namespace houghstream::ros_bag
