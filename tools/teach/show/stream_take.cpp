#include "tools/teach/show/stream_take.hpp"

#include <algorithm>
#include <utility>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/stop_signal.hpp"
#include "pipeline/bus/channel_pattern.hpp"
#include "pipeline/messages/messages.hpp"

namespace houghstream::teach {
namespace {

using std::chrono::milliseconds;

constexpr std::size_t kMostWaiting = 300;  // ten seconds at 30 Hz, some 60 MB
constexpr std::size_t kMostBytes = std::size_t{256} << 20U;
constexpr milliseconds kMoment(50);  // for which a stop signal may go unnoticed

}  // namespace

StreamTake::StreamTake(LcmBus& bus, StreamTakeSettings settings) : bus_(bus), settings_(std::move(settings)) {
  require(!bus_.is_log(), "{}: is a log, expected a network URL for a take of a stream; --source log:FILE takes a log",
          bus_.url());
  require(ChannelPattern(settings_.channel).is_name(), "channel '{}', expected the name of one camera's frames",
          settings_.channel);
  bus_.subscribe(settings_.channel, [this](const Arrival& arrival) { put(arrival); });
  const BlockStopSignals block;
  thread_ = std::thread([this] { receive(); });
}

StreamTake::~StreamTake() {
  receiving_ = false;
  thread_.join();
}

void StreamTake::receive() noexcept {
  try {
    while (receiving_) bus_.handle(kMoment);
  } catch (const std::exception& error) {
    const std::lock_guard lock(mutex_);
    failure_ = error.what();
    changed_.notify_all();
  }
}

void StreamTake::put(const Arrival& arrival) {
  const std::lock_guard lock(mutex_);
  if (ended_) return;
  last_ = arrival.time;
  if (!first_) first_ = arrival.time;
  waiting_.emplace_back(arrival.bytes.data, arrival.bytes.data + arrival.bytes.size);
  waiting_bytes_ += arrival.bytes.size;
  while (waiting_.size() > kMostWaiting || (waiting_.size() > 1 && waiting_bytes_ > kMostBytes)) {
    take_first();
    ++passed_over_;
  }
  changed_.notify_all();
}

void StreamTake::end() {
  const std::lock_guard lock(mutex_);
  ended_ = true;
  changed_.notify_all();
}

void StreamTake::skip_to_newest() {
  const std::lock_guard lock(mutex_);
  while (waiting_.size() > 1) take_first();
}

std::vector<std::uint8_t> StreamTake::take_first() {
  std::vector<std::uint8_t> first = std::move(waiting_.front());
  waiting_.pop_front();
  waiting_bytes_ -= first.size();
  return first;
}

StreamTake::Clock::time_point StreamTake::deadline() const {
  if (!first_) return begin_ + settings_.patience;
  return std::min(*first_ + settings_.longest, last_ + settings_.silence);
}

std::optional<std::vector<std::uint8_t>> StreamTake::take() {
  std::unique_lock lock(mutex_);
  while (waiting_.empty() && !ended_ && failure_.empty()) {
    changed_.wait_for(lock, kMoment);
    ended_ = ended_ || stop_requested() || Clock::now() > deadline();
  }
  ended_ = ended_ || stop_requested() || (first_ && Clock::now() > *first_ + settings_.longest);
  require(failure_.empty(), "{}", failure_);
  require(first_ || stop_requested(), "no frame within {:.0f} s on {} at {}, expected a stream that runs",
          std::chrono::duration<double>(settings_.patience).count(), settings_.channel, bus_.url());
  if (ended_ || waiting_.empty()) return std::nullopt;
  return take_first();
}

std::optional<RgbdFrame> StreamTake::next() {
  const std::optional<std::vector<std::uint8_t>> bytes = take();
  if (!bytes) return std::nullopt;
  try {
    const auto message = decode_message<images_t>({bytes->data(), bytes->size()});
    return frame_from_message(message, settings_.channel, settings_.camera);
  } catch (const InputError& error) {
    fail("{}: {}", settings_.channel, error.what());
  }
}

}  // namespace houghstream::teach
