#include "pipeline/bus/event_log.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/base/printable.hpp"
#include "pipeline/base/recording_log.hpp"
#include "pipeline/messages/channels.hpp"

namespace houghstream {
namespace {

constexpr std::array<std::uint8_t, 8> kMagic = {'H', 'S', 'S', 'E', 'A', 'L', '1', 0};

template <typename Number>
void append(Number number, std::vector<std::uint8_t>& bytes) {
  for (std::size_t shift = 8 * sizeof number; shift > 0; shift -= 8)
    bytes.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(number) >> (shift - 8)));
}

constexpr std::size_t kBlockBytes = std::size_t{64} << 20U;

void write_block(const std::vector<LogEvent>& block, LogWriter& out) {
  std::vector<std::uint32_t> checksums;
  checksums.reserve(block.size());
  for (const LogEvent& event : block) checksums.push_back(checksum_of(event));
  const std::vector<std::uint8_t> seal = encode_seal(checksums);
  out.write(block.front().timestamp, kSealChannel, {seal.data(), seal.size()});
  for (const LogEvent& event : block) out.write(event.timestamp, event.channel, {event.data.data(), event.data.size()});
}

}  // namespace

std::uint32_t checksum_of(const LogEvent& event) {
  std::vector<std::uint8_t> head;
  append(event.timestamp, head);
  head.insert(head.end(), event.channel.begin(), event.channel.end());
  return libdeflate_crc32(libdeflate_crc32(0, head.data(), head.size()), event.data.data(), event.data.size());
}

std::vector<std::uint8_t> encode_seal(const std::vector<std::uint32_t>& checksums) {
  std::vector<std::uint8_t> bytes(kMagic.begin(), kMagic.end());
  append(static_cast<std::uint32_t>(checksums.size()), bytes);
  for (const std::uint32_t checksum : checksums) append(checksum, bytes);
  return bytes;
}

std::vector<std::uint32_t> decode_seal(ByteView bytes, const std::string& source) {
  WireReader reader(bytes, source);
  const ByteView magic = reader.read_bytes(kMagic.size());
  require(std::equal(kMagic.begin(), kMagic.end(), magic.data), "{}: a damaged seal", source);
  std::vector<std::uint32_t> checksums(reader.read_count(4));
  require(checksums.size() <= kSealedBlock && reader.left() == 4 * checksums.size(), "{}: a damaged seal", source);
  for (std::uint32_t& checksum : checksums) checksum = static_cast<std::uint32_t>(reader.read_int32());
  return checksums;
}

std::int64_t seal_log(const std::filesystem::path& log_file, const std::filesystem::path& out_file,
                      const std::function<void(double fraction)>& tell) {
  require_other_file(out_file, log_file);
  LogReader log(log_file);
  LogWriter out(out_file);
  std::vector<LogEvent> block;
  std::size_t bytes = 0;
  std::int64_t events = 0;
  while (std::optional<LogEvent> event = log.next()) {
    bytes += event->data.size();
    block.push_back(std::move(*event));
    ++events;
    if (tell) tell(static_cast<double>(log.position()) / static_cast<double>(log.size()));
    if (block.size() < kSealedBlock && bytes < kBlockBytes) continue;
    write_block(block, out);
    block.clear();
    bytes = 0;
  }
  if (!block.empty()) write_block(block, out);
  out.close();
  return events;
}

namespace {

constexpr std::int32_t kSync = static_cast<std::int32_t>(0xEDA1DA01U);
constexpr std::size_t kHeaderBytes = 28;
constexpr std::uint32_t kMaxData = 1U << 28U;  // LCM sends no more

}  // namespace

void LogWriter::Closer::operator()(lcm_eventlog_t* log) const {
  lcm_eventlog_destroy(log);
}

LogWriter::LogWriter(const std::filesystem::path& file, Existing existing)
    : whole_(file, kPartialEnding, existing),
      file_(whole_.file().string()),
      log_(lcm_eventlog_create(whole_.partial().c_str(), "w")) {
  require(log_ != nullptr, "{}: cannot be written: {}", file_, std::strerror(errno));
  log_recording_names(whole_);
}

void LogWriter::write(std::int64_t timestamp, const std::string& channel, ByteView data) {
  require(!channel.empty() && channel.size() <= channel::kMaxBytes, "{}: a channel of {} bytes, expected 1 to {}",
          file_, channel.size(), channel::kMaxBytes);
  std::string name = channel;
  lcm_eventlog_event_t event{};
  event.timestamp = timestamp;
  event.channellen = static_cast<std::int32_t>(name.size());
  event.datalen = static_cast<std::int32_t>(data.size);
  event.channel = name.data();
  event.data = const_cast<std::uint8_t*>(data.data);  // the C interface reads it only
  const int failed = lcm_eventlog_write_event(log_.get(), &event);
  require(failed == 0, "{}: event {} could not be written: {}", file_, log_->eventcount, std::strerror(errno));
}

void LogWriter::close() {
  if (!log_) return;
  // An event whose writing failed has left the buffer, so that a successful flush of later events does not show it.
  const bool torn = std::ferror(log_->f) != 0;
  const bool flushed = std::fflush(log_->f) == 0;
  const int error = errno;
  log_.reset();
  require(!torn, "{}: an event could not be written, the log is torn", file_);
  require(flushed, "{}: the end of the log could not be written: {}", file_, std::strerror(error));
  whole_.commit();
}

void LogWriter::keep_partial() {
  log_.reset();
  whole_.keep_partial();
}

LogReader::LogReader(const std::filesystem::path& file) : file_(file.string()) {
  require_regular_file(file, "an LCM log");
  in_.reset(std::fopen(file_.c_str(), "rb"));
  require(in_ != nullptr, "{}: cannot be read: {}", file_, std::strerror(errno));
  std::error_code error;
  size_ = std::filesystem::file_size(file, error);
  require(!error, "{}: is not a log file: {}", file_, error.message());
  require(size_ > 0, "{}: is empty, expected an LCM log", file_);
}

void LogReader::seek(std::uint64_t position) {
  require(fseeko(in_.get(), static_cast<off_t>(position), SEEK_SET) == 0, "{}: byte {} cannot be reached: {}", file_,
          position, std::strerror(errno));
  position_ = position;
}

LogReader::Header LogReader::read_header() {
  const std::uint64_t left = size_ - position_;
  std::array<std::uint8_t, kHeaderBytes> bytes{};
  require(left >= kHeaderBytes && std::fread(bytes.data(), 1, kHeaderBytes, in_.get()) == kHeaderBytes,
          "{}: cut after event {}: {} bytes left at byte {}, expected a header of {}", file_, events_, left, position_,
          kHeaderBytes);
  WireReader reader({bytes.data(), bytes.size()}, file_);
  const std::int32_t sync = reader.read_int32();
  require(sync == kSync, "{}: no event header at byte {} after event {}: {:08x}, expected {:08x}", file_, position_,
          events_, static_cast<std::uint32_t>(sync), static_cast<std::uint32_t>(kSync));
  reader.skip(8);
  Header header;
  header.timestamp = reader.read_int64();
  header.channel_bytes = static_cast<std::uint32_t>(reader.read_int32());
  header.data_bytes = static_cast<std::uint32_t>(reader.read_int32());
  require(header.channel_bytes >= 1 && header.channel_bytes <= channel::kMaxBytes,
          "{}: event {} has a channel of {} bytes, expected 1 to {}", file_, events_, header.channel_bytes,
          channel::kMaxBytes);
  const std::uint64_t event_bytes = kHeaderBytes + std::uint64_t{header.channel_bytes} + header.data_bytes;
  require(event_bytes <= left, "{}: cut in event {}: {} of its {} bytes are there", file_, events_, left, event_bytes);
  require(header.data_bytes <= kMaxData, "{}: event {} has a message of {} bytes, expected at most {}", file_, events_,
          header.data_bytes, kMaxData);
  return header;
}

std::optional<LogEvent> LogReader::next() {
  while (true) {
    std::optional<LogEvent> event = read_event();
    if (!event) {
      const std::size_t missing = std::exchange(seals_, {}).size();
      require(missing == 0, "{}: cut after event {}: {} sealed {} missing", file_, events_, missing,
              missing == 1 ? "event is" : "events are");
      return std::nullopt;
    }
    if (event->channel != kSealChannel) {
      break_seal(*event);
      return event;
    }
    const std::size_t missing = std::exchange(seals_, {}).size();
    const std::vector<std::uint32_t> checksums = decode_seal({event->data.data(), event->data.size()}, file_);
    seals_.assign(checksums.begin(), checksums.end());
    is_sealed_ = true;
    is_unlike_seal_ = missing > 0;
    require(missing == 0, "{}: {} sealed events are missing before event {}", file_, missing, events_);
  }
}

void LogReader::break_seal(const LogEvent& event) {
  if (seals_.empty()) return;
  const std::uint32_t expected = seals_.front();
  seals_.pop_front();
  is_unlike_seal_ = checksum_of(event) != expected;
  require(!is_unlike_seal_, "{}: event {} on {} is damaged: checksum {:08x}, its seal says {:08x}", file_, events_ - 1,
          printable(event.channel), checksum_of(event), expected);
}

std::optional<LogEvent> LogReader::read_event() {
  if (position_ == size_) return std::nullopt;
  const Header header = read_header();
  LogEvent event;
  event.timestamp = header.timestamp;
  event.channel.resize(header.channel_bytes);
  event.data.resize(header.data_bytes);
  const bool read = std::fread(event.channel.data(), 1, header.channel_bytes, in_.get()) == header.channel_bytes &&
                    std::fread(event.data.data(), 1, header.data_bytes, in_.get()) == header.data_bytes;
  require(read, "{}: event {} cannot be read: {}", file_, events_, std::strerror(errno));
  last_position_ = position_;
  position_ += kHeaderBytes + std::uint64_t{header.channel_bytes} + header.data_bytes;
  ++events_;
  return event;
}

bool LogReader::is_event_at(std::uint64_t position) {
  seek(position);
  try {
    std::string channel(read_header().channel_bytes, ' ');
    const bool read = std::fread(channel.data(), 1, channel.size(), in_.get()) == channel.size();
    return read && std::all_of(channel.begin(), channel.end(), [](char c) { return c > ' ' && c <= '~'; });
  } catch (const InputError&) {
    return false;
  }
}

std::optional<std::uint64_t> LogReader::find_event(std::uint64_t from) {
  constexpr std::array<char, 4> kSyncBytes = {'\xED', '\xA1', '\xDA', '\x01'};
  constexpr std::size_t kFirstChunk = std::size_t{1} << 12U;  // the next event may be near, again and again
  constexpr std::size_t kChunk = std::size_t{1} << 20U;
  std::vector<char> chunk(kFirstChunk);
  for (; from + kHeaderBytes <= size_; chunk.resize(std::min(2 * chunk.size(), kChunk))) {
    seek(from);
    const std::size_t read = std::fread(chunk.data(), 1, chunk.size(), in_.get());
    if (read < kHeaderBytes) return std::nullopt;
    const auto end = chunk.begin() + static_cast<std::ptrdiff_t>(read);
    for (auto at = chunk.begin();; ++at) {
      at = std::search(at, end, kSyncBytes.begin(), kSyncBytes.end());
      if (at == end) break;
      const std::uint64_t position = from + static_cast<std::uint64_t>(at - chunk.begin());
      if (is_event_at(position)) return position;
    }
    from += read - (kSyncBytes.size() - 1);  // a sync word may lie across the border
  }
  return std::nullopt;
}

LogReader::Damage LogReader::skip_damage() {
  if (std::exchange(is_unlike_seal_, false)) return {position_ - last_position_, false};
  seals_.clear();  // the part of the log that they belong to is unknown
  const std::uint64_t damaged = position_;
  // A wrong length in a header reaches into later events: those are looked for too. A forged log may hold nothing but
  // such headers, each of which would have the rest read once more.
  const std::uint64_t max_again = 4 * size_ + (std::uint64_t{1} << 20U);
  const bool goes_back = events_ > 0 && looked_again_ + (damaged - last_position_) <= max_again;
  const std::uint64_t from = (goes_back ? last_position_ : damaged) + 1;
  if (goes_back) looked_again_ += damaged - last_position_;
  std::optional<std::uint64_t> found = find_event(from);
  if (found && *found == damaged) found = find_event(damaged + 1);
  const bool last_event_too = found && *found < damaged;
  seek(found.value_or(size_));
  return {position_ - (last_event_too ? last_position_ : damaged), last_event_too};
}

}  // namespace houghstream
