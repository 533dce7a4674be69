#include "tools/teach/show/stream_take.hpp"

#include <algorithm>
#include <utility>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/base/stop_signal.hpp"
#include "pipeline/bus/channel_pattern.hpp"
#include "pipeline/messages/messages.hpp"

namespace houghstream::teach {
namespace {

using std::chrono::milliseconds;

constexpr std::size_t kMaxWaiting = 300;  // ten seconds at 30 Hz, some 60 MB
constexpr std::size_t kMaxBytes = std::size_t{256} << 20U;
constexpr milliseconds kMoment(50);  // time for which a stop signal may go unnoticed

}  // namespace

StreamTake::StreamTake(LcmBus& bus, StreamTakeSettings settings) : bus_(bus), settings_(std::move(settings)) {
  require(!bus_.is_log(), "{}: is a log, expected a network URL for a take of a stream; --source log:FILE takes a log",
          bus_.url());
  require(ChannelPattern(settings_.channel).is_name(), "channel '{}', expected the name of one camera's frames",
          settings_.channel);
  bus_.subscribe_to_frames(settings_.channel, [this](const ReceivedMessage& arrival) { push(arrival); });
  const BlockStopSignals block;
  thread_ = std::thread([this] { receive(); });
}

StreamTake::~StreamTake() {
  receiving_ = false;
  thread_.join();
}

void StreamTake::receive() noexcept {
  try {
    while (receiving_) {
      const Clock::time_point begin = Clock::now();
      bus_.handle(kMoment);
      if (!bus_.is_reachable()) note_outage(Clock::now() - begin);
    }
  } catch (const std::exception& error) {
    const std::lock_guard lock(mutex_);
    failure_ = error.what();
    changed_.notify_all();
  }
}

// Time in which nothing could come is no silence of the stream, and is no part of the take.
void StreamTake::note_outage(Clock::duration time) {
  const std::lock_guard lock(mutex_);
  begin_ += time;
  last_ += time;
  if (first_) *first_ += time;
}

// Messages that are no frames are never queued: they would displace frames.
void StreamTake::push(const ReceivedMessage& arrival) {
  const std::lock_guard lock(mutex_);
  if (ended_) return;
  try {
    read_frame_header(arrival.bytes);
  } catch (const InputError& error) {
    refuse(error.what());
    return;
  }
  waiting_.push_back({{arrival.bytes.data, arrival.bytes.data + arrival.bytes.size}, arrival.time});
  waiting_bytes_ += arrival.bytes.size;
  while (waiting_.size() > kMaxWaiting || (waiting_.size() > 1 && waiting_bytes_ > kMaxBytes)) {
    drop_first();
    ++passed_over_;
  }
  changed_.notify_all();
}

void StreamTake::refuse(const std::string& reason) {
  ++refused_;
  last_reason_ = reason;
  const std::string line = fmt::format("message on {} dropped: {}", settings_.channel, reason);
  if (const auto admitted = throttle_.admit("", line, Clock::now())) log_warning("{}", *admitted);
}

void StreamTake::end() {
  const std::lock_guard lock(mutex_);
  ended_ = true;
  changed_.notify_all();
}

void StreamTake::skip_to_newest() {
  const std::lock_guard lock(mutex_);
  while (waiting_.size() > 1) drop_first();
}

StreamTake::Waiting StreamTake::pop_first() {
  Waiting first = std::move(waiting_.front());
  waiting_.pop_front();
  waiting_bytes_ -= first.bytes.size();
  return first;
}

// A stream whose frames are too many to be taken is not silent.
void StreamTake::drop_first() {
  last_ = pop_first().arrival;
}

StreamTake::Clock::time_point StreamTake::deadline() const {
  if (!first_) return begin_ + settings_.first_frame_timeout;
  return std::min(*first_ + settings_.max_length, last_ + settings_.frame_timeout);
}

void StreamTake::require_stream() const {
  const double seconds = std::chrono::duration<double>(settings_.first_frame_timeout).count();
  require(refused_ == 0, "no frame within {:.0f} s on {} at {}: {} messages were refused, the last: {}", seconds,
          settings_.channel, bus_.url(), refused_.load(), last_reason_);
  fail("no frame within {:.0f} s on {} at {}, expected a stream that runs", seconds, settings_.channel, bus_.url());
}

std::optional<StreamTake::Waiting> StreamTake::pop() {
  std::unique_lock lock(mutex_);
  while (waiting_.empty() && !ended_ && failure_.empty()) {
    changed_.wait_for(lock, kMoment);
    ended_ = ended_ || stop_requested() || Clock::now() > deadline();
  }
  ended_ = ended_ || stop_requested() || (first_ && Clock::now() > *first_ + settings_.max_length);
  require(failure_.empty(), "{}", failure_);
  // A message that came after the deadline would be too late even if it were a frame.
  ended_ = ended_ || (!waiting_.empty() && waiting_.front().arrival > deadline());
  if (ended_ && !first_ && !stop_requested()) require_stream();
  if (ended_) return std::nullopt;
  return pop_first();
}

RgbdFrame StreamTake::decode(const std::vector<std::uint8_t>& bytes) const {
  const auto message = decode_message<images_t>({bytes.data(), bytes.size()});
  RgbdFrame frame = frame_from_message(message, settings_.channel, settings_.camera);
  require(size_.empty() || frame.depth.size() == size_, "frame {}: {}x{} pixels, expected {}x{} as of the first frame",
          to_string(frame.id), frame.depth.cols, frame.depth.rows, size_.width, size_.height);
  return frame;
}

void StreamTake::note_frame(const RgbdFrame& frame, Clock::time_point arrival) {
  const std::lock_guard lock(mutex_);
  if (!first_) {
    first_ = arrival;
    size_ = frame.depth.size();
  }
  last_ = arrival;
}

std::optional<RgbdFrame> StreamTake::next() {
  while (const std::optional<Waiting> message = pop()) {
    try {
      RgbdFrame frame = decode(message->bytes);
      note_frame(frame, message->arrival);
      return frame;
    } catch (const InputError& error) {
      const std::lock_guard lock(mutex_);
      refuse(error.what());
    }
  }
  return std::nullopt;
}

}  // namespace houghstream::teach
