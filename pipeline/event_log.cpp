#include "pipeline/event_log.hpp"

#include <array>
#include <cerrno>
#include <cstring>

#include "pipeline/checks.hpp"

namespace houghstream {
namespace {

constexpr std::int32_t kSync = static_cast<std::int32_t>(0xEDA1DA01U);
constexpr std::size_t kHeaderBytes = 28;
// LCM's reader refuses longer ones.
constexpr std::size_t kMaxChannelBytes = 999;

}  // namespace

void LogWriter::Closer::operator()(lcm_eventlog_t* log) const {
  lcm_eventlog_destroy(log);
}

LogWriter::LogWriter(const std::filesystem::path& file)
    : file_(file.string()), log_(lcm_eventlog_create(file_.c_str(), "w")) {
  require(log_ != nullptr, "{}: cannot be written: {}", file_, std::strerror(errno));
}

void LogWriter::write(std::int64_t timestamp, const std::string& channel, ByteView data) {
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
  const bool flushed = std::fflush(log_->f) == 0;
  const int error = errno;
  log_.reset();
  require(flushed, "{}: the end of the log could not be written: {}", file_, std::strerror(error));
}

LogReader::LogReader(const std::filesystem::path& file) : file_(file.string()), in_(std::fopen(file_.c_str(), "rb")) {
  require(in_ != nullptr, "{}: cannot be read: {}", file_, std::strerror(errno));
  std::error_code error;
  size_ = std::filesystem::file_size(file, error);
  require(!error, "{}: is not a log file: {}", file_, error.message());
  require(size_ > 0, "{}: is empty, expected an LCM log", file_);
}

std::optional<LogEvent> LogReader::next() {
  if (position_ == size_) return std::nullopt;
  const std::uint64_t left = size_ - position_;
  std::array<std::uint8_t, kHeaderBytes> header{};
  require(left >= kHeaderBytes && std::fread(header.data(), 1, kHeaderBytes, in_.get()) == kHeaderBytes,
          "{}: cut after event {}: {} bytes left at byte {}, expected a header of {}", file_, events_, left, position_,
          kHeaderBytes);
  WireReader reader({header.data(), header.size()}, file_);
  const std::int32_t sync = reader.read_int32();
  require(sync == kSync, "{}: no event header at byte {} after event {}: {:08x}, expected {:08x}", file_, position_,
          events_, static_cast<std::uint32_t>(sync), static_cast<std::uint32_t>(kSync));
  reader.skip(8);
  LogEvent event;
  event.timestamp = reader.read_int64();
  const auto channel_bytes = static_cast<std::uint32_t>(reader.read_int32());
  const auto data_bytes = static_cast<std::uint32_t>(reader.read_int32());
  require(channel_bytes >= 1 && channel_bytes <= kMaxChannelBytes,
          "{}: event {} has a channel of {} bytes, expected 1 to {}", file_, events_, channel_bytes, kMaxChannelBytes);
  const std::uint64_t event_bytes = kHeaderBytes + std::uint64_t{channel_bytes} + data_bytes;
  require(event_bytes <= left, "{}: cut in event {}: {} of its {} bytes are there", file_, events_, left, event_bytes);
  event.channel.resize(channel_bytes);
  event.data.resize(data_bytes);
  const bool read = std::fread(event.channel.data(), 1, channel_bytes, in_.get()) == channel_bytes &&
                    std::fread(event.data.data(), 1, data_bytes, in_.get()) == data_bytes;
  require(read, "{}: event {} cannot be read: {}", file_, events_, std::strerror(errno));
  position_ += event_bytes;
  ++events_;
  return event;
}

}  // namespace houghstream
