#include "tools/log/record_log.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <set>
#include <thread>
#include <utility>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/base/service_notice.hpp"
#include "pipeline/base/stop_signal.hpp"
#include "pipeline/bus/event_log.hpp"
#include "pipeline/bus/lcm_bus.hpp"
#include "pipeline/bus/local_filter.hpp"
#include "pipeline/bus/receive_buffer.hpp"
#include "pipeline/bus/sequence_tracker.hpp"

namespace houghstream::log_tools {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kWaitingBytes = std::size_t{512} << 20U;  // may wait for a slow disk: ten seconds of raw frames

/// Writes events in a thread of its own, so that a disk that pauses keeps no message in the kernel's buffer.
class EventWriter {
 public:
  EventWriter(const std::string& file, Existing existing) : log_(file, existing) {
    const BlockStopSignals block;
    thread_ = std::thread([this] { run(); });
  }
  ~EventWriter() { end(); }
  EventWriter(const EventWriter&) = delete;
  EventWriter& operator=(const EventWriter&) = delete;

  /// Returns false where too much waits already: the event is then not written.
  bool add(LogEvent event) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (waiting_bytes_ + event.data.size() > kWaitingBytes) return false;
    waiting_bytes_ += event.data.size();
    waiting_.push_back(std::move(event));
    changed_.notify_one();
    return true;
  }

  bool has_failed() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return failure_ != nullptr;
  }

  /// Writes what waits and puts the log into its place. Returns its name. Throws InputError where the disk refuses.
  std::string finish() {
    end();
    try {
      if (failure_) std::rethrow_exception(failure_);
      log_.close();
    } catch (const InputError& error) {
      log_.keep_partial();  // it cannot be repeated
      fail("{}; what was recorded until then is in {} (hs-log filter makes a log of it)", error.what(),
           log_.partial().string());
    }
    return log_.file().string();
  }

  std::string file() const { return log_.file().string(); }

 private:
  void end() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      is_ending_ = true;
      changed_.notify_one();
    }
    if (thread_.joinable()) thread_.join();
  }

  void run() {
    std::unique_lock<std::mutex> lock(mutex_);
    while (true) {
      changed_.wait(lock, [this] { return is_ending_ || !waiting_.empty(); });
      if (waiting_.empty() || failure_) return;
      const LogEvent event = std::move(waiting_.front());
      waiting_.pop_front();
      lock.unlock();
      std::exception_ptr failure;
      try {
        log_.write(event.timestamp, event.channel, {event.data.data(), event.data.size()});
      } catch (const InputError&) {
        failure = std::current_exception();
      }
      lock.lock();
      waiting_bytes_ -= event.data.size();
      failure_ = failure;
    }
  }

  LogWriter log_;
  std::mutex mutex_;  // guards the next five
  std::condition_variable changed_;
  std::deque<LogEvent> waiting_;
  std::size_t waiting_bytes_ = 0;
  bool is_ending_ = false;
  std::exception_ptr failure_;
  std::thread thread_;
};

/// Records what a bus receives.
class Recorder {
 public:
  explicit Recorder(const RecordSettings& settings) : writer_(settings.file, existing_of_recording(settings.replace)) {}

  void note(const ReceivedMessage& message) {
    LogEvent event;
    event.timestamp = message.event_us;
    event.channel = message.channel;
    event.data.assign(message.bytes.data, message.bytes.data + message.bytes.size);
    count_frame(message);
    if (!writer_.add(std::move(event))) {
      ++result_.unwritten;
      return;
    }
    ++result_.events;
    result_.bytes += static_cast<std::int64_t>(message.bytes.size);
    channels_.insert(message.channel);
  }

  std::int64_t events() const { return result_.events; }
  bool has_failed() { return writer_.has_failed(); }
  std::string file() const { return writer_.file(); }

  RecordResult finish() {
    result_.file = writer_.finish();
    result_.channels = channels_.size();
    for (const auto& [channel, numbers] : numbers_) {
      if (const std::optional<std::int64_t> lost = numbers.lost()) result_.frames_lost[channel] = *lost;
    }
    return result_;
  }

 private:
  void count_frame(const ReceivedMessage& message) {
    if (!is_frame_message(message.bytes)) return;
    try {
      const FrameHeader header = read_frame_header(message.bytes);
      const auto now = std::chrono::duration_cast<std::chrono::microseconds>(message.time.time_since_epoch());
      numbers_[message.channel].note({header.sequence, header.utime, header.run}, now.count());
    } catch (const InputError&) {
      // A message that is no whole frame is recorded as any other one is, and has no number.
    }
  }

  EventWriter writer_;
  RecordResult result_;
  std::set<std::string> channels_;
  std::map<std::string, SequenceTracker> numbers_;
};

/// Returns one expression that matches where one of these does.
std::string join_patterns(const std::vector<std::string>& patterns) {
  if (patterns.empty()) return ".*";
  if (patterns.size() == 1) return patterns.front();
  return fmt::format("({})", fmt::join(patterns, ")|("));
}

std::optional<std::int64_t> sum_dropped(const std::vector<int>& sockets) {
  if (sockets.empty()) return std::nullopt;  // a server's connection loses nothing
  std::int64_t sum = 0;
  try {
    for (const int socket : sockets) sum += count_dropped_datagrams(socket);
  } catch (const InputError& error) {
    log_warning("{}", error.what());
    return std::nullopt;
  }
  return sum;
}

/// Takes what has arrived before the stop signal: until the kernel holds nothing and nothing has come for a moment.
/// LCM's thread of its own empties the kernel's buffer, and on a busy machine it can be late by more than that moment.
void drain(LcmBus& bus, const std::vector<int>& sockets, const Recorder& recorder) {
  constexpr std::chrono::milliseconds kQuiet(30);
  constexpr std::chrono::seconds kLongest(2);  // others may go on sending
  const Clock::time_point end = Clock::now() + kLongest;
  bool is_quiet = false;
  while (!is_quiet && Clock::now() < end) {
    const std::int64_t before = recorder.events();
    const bool was_read = std::none_of(sockets.begin(), sockets.end(), has_waiting_datagram);
    bus.handle(kQuiet);
    is_quiet = was_read && recorder.events() == before;
  }
}

}  // namespace

bool RecordResult::is_complete() const {
  std::int64_t frames = 0;
  for (const auto& [channel, lost] : frames_lost) frames += lost;
  return frames == 0 && unwritten == 0 && dropped.value_or(0) == 0;
}

std::string RecordResult::losses_line() const {
  if (is_complete()) {
    return dropped ? "nothing was lost: the kernel has dropped no datagram"
                   : "no loss is known of: the numbering of frames has no gap";
  }
  std::vector<std::string> parts;
  for (const auto& [channel, lost] : frames_lost) {
    if (lost > 0) parts.push_back(fmt::format("{} frames of {} are missing in its numbering", lost, channel));
  }
  if (unwritten > 0) parts.push_back(fmt::format("{} messages came faster than the disk takes them", unwritten));
  if (dropped.value_or(0) > 0) {
    parts.push_back(fmt::format("the kernel dropped {} datagrams of at most 64 kB; mend it with: {}", *dropped,
                                receive_buffer_remedy()));
  }
  return fmt::format("lost: {}", fmt::join(parts, "; "));
}

RecordResult record_log(const RecordSettings& settings) {
  LcmBus bus(settings.url);
  require(!bus.is_log(), "{}: a log is copied by hs-log filter, expected a network URL", bus.url());
  const std::string channels = join_patterns(settings.channels);
  Recorder recorder(settings);
  catch_stop_signals();
  bus.subscribe_unbounded(channels, [&](const ReceivedMessage& message) { recorder.note(message); });
  const std::vector<int> sockets = find_receive_sockets(bus.url());
  for (const int socket : sockets) force_receive_buffer(socket, kAskedReceiveBuffer);
  const std::optional<std::int64_t> dropped_before = sum_dropped(sockets);
  log_info("ready: recording {} to {}", channels == ".*" ? "all channels" : channels, recorder.file());
  notify_service("READY=1");

  const Clock::time_point start = Clock::now();
  const std::chrono::duration<double> limit(settings.seconds);
  while (!stop_requested() && !recorder.has_failed() && (settings.seconds <= 0.0 || Clock::now() - start < limit))
    bus.handle(std::chrono::milliseconds(50));
  drain(bus, sockets, recorder);
  const std::optional<std::int64_t> dropped = sum_dropped(sockets);
  const StillFinishing finishing;
  require(recorder.events() > 0, "no message on {} at {}, expected at least one", channels, bus.url());
  RecordResult result = recorder.finish();
  if (dropped && dropped_before) result.dropped = *dropped - *dropped_before;
  return result;
}

}  // namespace houghstream::log_tools
