#include "drivers/ros_bag/bag_file.hpp"

#include <algorithm>

#include "drivers/ros_bag/chunk_data.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/base/printable.hpp"

namespace houghstream::ros_bag {
namespace {

constexpr const char* kVersionLine = "#ROSBAG V2.0\n";
constexpr std::size_t kMaxChunk = std::size_t{512} << 20U;     // bytes; rosbag's recorder writes less than one MB
constexpr std::size_t kMaxIndex = std::size_t{256} << 20U;     // bytes: that of a million chunks
constexpr std::size_t kMaxWaiting = std::size_t{1024} << 20U;  // bytes

enum Op : std::uint8_t { kMessage = 2, kBagHeader = 3, kChunk = 5, kChunkInfo = 6, kConnection = 7 };

/// Holds the header of a record, or a connection's: NAME=VALUE, in any order.
class Fields {
 public:
  Fields(ByteRange bytes, const std::string& source) : source_(source) {
    ByteReader reader(bytes, source);
    while (reader.left() > 0) {
      const std::string field = reader.read_text();
      const std::size_t equals = field.find('=');
      require(equals != std::string::npos, "{}: field '{}', expected NAME=VALUE", source, printable(field));
      values_[field.substr(0, equals)] = field.substr(equals + 1);
    }
  }

  const std::string& text(const std::string& name) const {
    const auto found = values_.find(name);
    require(found != values_.end(), "{}: no field '{}', expected one: it is damaged", source_, name);
    return found->second;
  }

  template <typename Number>
  Number number(const std::string& name) const {
    const std::string& value = text(name);
    require(value.size() == sizeof(Number), "{}: field '{}' of {} bytes, expected {}", source_, name, value.size(),
            sizeof(Number));
    Number number{};
    std::memcpy(&number, value.data(), sizeof number);
    return number;
  }

  /// Returns seconds and nanoseconds, two uint32, as nanoseconds.
  std::int64_t time_ns(const std::string& name) const {
    const auto value = number<std::uint64_t>(name);
    constexpr std::int64_t kSecond = 1'000'000'000;
    return static_cast<std::int64_t>(value & 0xFFFFFFFFU) * kSecond + static_cast<std::int64_t>(value >> 32U);
  }

  void require_op(Op expected) const {
    const int op = number<std::uint8_t>("op");
    require(op == expected, "{}: record of kind {}, expected {}: it is damaged", source_, op,
            static_cast<int>(expected));
  }

  bool has(const std::string& name) const { return values_.count(name) > 0; }

 private:
  std::string source_;
  std::map<std::string, std::string> values_;
};

BagConnection read_connection(ByteReader& reader) {
  const Fields header(reader.read_sized(), reader.source());
  header.require_op(kConnection);
  const Fields data(reader.read_sized(), reader.source());
  return {header.number<std::uint32_t>("conn"), header.text("topic"), data.text("type")};
}

BagChunk read_chunk_info(ByteReader& reader) {
  const Fields header(reader.read_sized(), reader.source());
  header.require_op(kChunkInfo);
  const auto version = header.number<std::uint32_t>("ver");
  require(version == 1, "{}: chunks described in version {}, expected 1", reader.source(), version);
  BagChunk chunk;
  chunk.position = header.number<std::uint64_t>("chunk_pos");
  chunk.start_ns = header.time_ns("start_time");
  ByteReader counts(reader.read_sized(), reader.source());
  for (auto left = header.number<std::uint32_t>("count"); left > 0; --left) {
    const auto connection = counts.read<std::uint32_t>();
    const auto messages = counts.read<std::uint32_t>();
    if (messages > 0) chunk.counts[connection] += messages;
  }
  counts.require_end();
  return chunk;
}

/// Returns the wanted messages, and counts all.
std::vector<BagMessage> messages_of(ByteReader reader, const std::set<std::uint32_t>& wanted,
                                    std::map<std::uint32_t, std::uint32_t>& counts) {
  std::vector<BagMessage> messages;
  while (reader.left() > 0) {
    const Fields header(reader.read_sized(), reader.source());
    const ByteRange data = reader.read_sized();
    if (header.number<std::uint8_t>("op") == kConnection) continue;
    header.require_op(kMessage);
    const auto connection = header.number<std::uint32_t>("conn");
    ++counts[connection];
    if (wanted.count(connection) == 0) continue;
    messages.push_back({connection, header.time_ns("time"), {data.data, data.data + data.size}});
  }
  return messages;
}

}  // namespace

BagFile::BagFile(const std::filesystem::path& file) : name_(file.string()) {
  require_regular_file(file, "a ROS bag");
  in_.open(file, std::ios::binary);
  require(in_.good(), "{}: cannot be read, expected a ROS bag", name_);
  size_ = std::filesystem::file_size(file);
  const std::string version = kVersionLine;
  std::string begin(std::min<std::uint64_t>(size_, version.size()), '\0');
  in_.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  require(begin.rfind("#ROS", 0) == 0, "{}: is no ROS bag, expected {} at its beginning", name_,
          version.substr(0, version.size() - 1));
  require(begin == version, "{}: begins with {}, expected #ROSBAG V2.0; rosbag fix converts older bags", name_,
          printable(begin.substr(0, begin.find('\n'))));
  constexpr std::uint64_t kMaxHeader = 1U << 16U;  // rosbag pads it to 4096 bytes
  const std::uint64_t header_size = std::min(size_ - version.size(), kMaxHeader);
  const std::vector<std::uint8_t> bytes = read_at(version.size(), header_size, "header");
  ByteReader reader({bytes.data(), bytes.size()}, name_ + ", header");
  const Fields header(reader.read_sized(), reader.source());
  header.require_op(kBagHeader);
  require(!header.has("encryptor") || header.text("encryptor").empty(), "{}: is encrypted, expected a plain bag",
          name_);
  const auto index = header.number<std::uint64_t>("index_pos");
  require(index != 0,
          "{}: has no index, expected a bag that was closed: its recorder was killed or is still at work; rosbag "
          "reindex makes an index",
          name_);
  require(index <= size_, "{}: is cut at {} bytes, expected its index at byte {}", name_, size_, index);
  read_index(index, header.number<std::uint32_t>("conn_count"), header.number<std::uint32_t>("chunk_count"));
}

void BagFile::read_index(std::uint64_t position, std::uint32_t connections, std::uint32_t chunks) {
  const std::uint64_t size = size_ - position;
  require(size <= kMaxIndex, "{}: an index of {} bytes, expected at most {}", name_, size, kMaxIndex);
  const std::vector<std::uint8_t> bytes = read_at(position, size, "index");
  ByteReader reader({bytes.data(), bytes.size()}, name_ + ", index");
  std::set<std::uint32_t> ids;
  for (std::uint32_t i = 0; i < connections; ++i) {
    connections_.push_back(read_connection(reader));
    require(ids.insert(connections_.back().id).second, "{}: connection {} twice, expected it once", reader.source(),
            connections_.back().id);
  }
  for (std::uint32_t i = 0; i < chunks; ++i) chunks_.push_back(read_chunk_info(reader));
  reader.require_end();
  for (const BagChunk& chunk : chunks_) {
    for (const auto& [connection, count] : chunk.counts)
      require(ids.count(connection) > 0, "{}: messages of connection {}, expected one that is listed", reader.source(),
              connection);
  }
  std::stable_sort(chunks_.begin(), chunks_.end(),
                   [](const BagChunk& a, const BagChunk& b) { return a.start_ns < b.start_ns; });
}

std::vector<std::uint8_t> BagFile::read_at(std::uint64_t position, std::uint64_t size, const char* what) {
  require(position <= size_ && size <= size_ - position, "{}: is cut at {} bytes, expected {} of {} bytes at byte {}",
          name_, size_, what, size, position);
  std::vector<std::uint8_t> bytes(size);
  in_.clear();
  in_.seekg(static_cast<std::streamoff>(position));
  in_.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  require(in_.good(), "{}: cannot be read at byte {}, expected {} of {} bytes", name_, position, what, size);
  return bytes;
}

std::vector<BagMessage> BagFile::read_chunk(const BagChunk& chunk, const std::set<std::uint32_t>& connections) {
  const std::string source = fmt::format("{}, chunk at byte {}", name_, chunk.position);
  const auto length_at = [&](std::uint64_t position) {
    const std::vector<std::uint8_t> bytes = read_at(position, sizeof(std::uint32_t), "a chunk");
    return ByteReader({bytes.data(), bytes.size()}, source).read<std::uint32_t>();
  };
  const std::uint64_t head = chunk.position + sizeof(std::uint32_t);
  const std::uint32_t head_size = length_at(chunk.position);
  const std::vector<std::uint8_t> head_bytes = read_at(head, head_size, "a chunk's header");
  const Fields header({head_bytes.data(), head_bytes.size()}, source);
  header.require_op(kChunk);
  const std::uint32_t data_size = length_at(head + head_size);
  const auto stated = header.number<std::uint32_t>("size");
  require(stated <= kMaxChunk && data_size <= kMaxChunk, "{}: {} bytes, expected at most {}", source,
          std::max(stated, data_size), kMaxChunk);
  const std::vector<std::uint8_t> data = read_at(head + head_size + sizeof(std::uint32_t), data_size, "a chunk");
  const std::vector<std::uint8_t> records =
      decompress_chunk({data.data(), data.size()}, header.text("compression"), stated, source);
  std::map<std::uint32_t, std::uint32_t> counts;
  std::vector<BagMessage> messages =
      messages_of(ByteReader({records.data(), records.size()}, source), connections, counts);
  require(counts == chunk.counts, "{}: its messages are not those that the index counts: it is damaged", source);
  return messages;
}

BagMessages::BagMessages(BagFile& file, std::set<std::uint32_t> connections)
    : file_(file), connections_(std::move(connections)) {
  for (const BagChunk& chunk : file.chunks()) {
    const bool is_wanted = std::any_of(chunk.counts.begin(), chunk.counts.end(), [&](const auto& count) {
      return count.second > 0 && connections_.count(count.first) > 0;
    });
    if (is_wanted) chunks_.push_back(&chunk);
  }
}

std::optional<BagMessage> BagMessages::next() {
  while (next_chunk_ < chunks_.size() &&
         (waiting_.empty() || chunks_[next_chunk_]->start_ns <= waiting_.begin()->first)) {
    read_chunk();
  }
  if (waiting_.empty()) return std::nullopt;
  BagMessage message = std::move(waiting_.begin()->second);
  waiting_.erase(waiting_.begin());
  waiting_bytes_ -= message.bytes.size();
  return message;
}

void BagMessages::read_chunk() {
  for (BagMessage& message : file_.read_chunk(*chunks_[next_chunk_], connections_)) {
    waiting_bytes_ += message.bytes.size();
    const std::int64_t time = message.received_ns;
    waiting_.emplace(time, std::move(message));
  }
  ++next_chunk_;
  require(waiting_bytes_ <= kMaxWaiting,
          "{}: more than {} MB of messages in chunks whose times overlap, expected a bag in the order of time",
          file_.name(), kMaxWaiting >> 20U);
}

}  // namespace houghstream::ros_bag
