#include "pipeline/bus/status_reporter.hpp"

#include <unistd.h>

#include <algorithm>

#include "pipeline/base/host_clock.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/bus/percentiles.hpp"
#include "pipeline/messages/channels.hpp"
#include "pipeline/messages/messages.hpp"

namespace houghstream {
namespace {

constexpr std::chrono::seconds kPeriod(1);
constexpr std::size_t kMaxSources = 256;           // a sender of rubbish may make up channels without end
constexpr std::size_t kMaxReasonLength = 1000;     // bytes, since it may quote a received message
constexpr std::chrono::seconds kLatencyWindow(5);  // enough frames at 30 Hz for a 99th percentile

std::string shortened(const std::string& reason) {
  return reason.size() <= kMaxReasonLength ? reason : reason.substr(0, kMaxReasonLength) + "...";
}

}  // namespace

StatusReporter::StatusReporter(std::string process) : process_(std::move(process)) {}

void StatusReporter::count_received() {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++received_;
}

FrameOrder StatusReporter::note_number(const FrameNumber& number, const std::string& source) {
  const std::int64_t now_us =
      std::chrono::duration_cast<std::chrono::microseconds>(Clock::now().time_since_epoch()).count();
  const std::lock_guard<std::mutex> lock(mutex_);
  if (sequences_.size() >= kMaxSources && sequences_.count(source) == 0) return FrameOrder::kNext;
  const FrameOrder order = sequences_[source].note(number, now_us);
  if (order == FrameOrder::kDuplicate) ++duplicates_;
  return order;
}

void StatusReporter::note_duplicate() {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++duplicates_;
}

void StatusReporter::count_skipped(std::int64_t frames) {
  const std::lock_guard<std::mutex> lock(mutex_);
  skipped_ += frames;
}

void StatusReporter::count_processed(Clock::duration latency) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++processed_;
  const Clock::time_point now = Clock::now();
  recent_.push_back({now, std::chrono::duration<double, std::milli>(latency).count()});
  while (recent_.front().time < now - kLatencyWindow) recent_.pop_front();
}

void StatusReporter::count_refused(const std::string& reason, const std::string& kind) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++refused_;
  log_throttled(kind, reason);
}

void StatusReporter::note_bad_message(const std::string& reason) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++bad_messages_;
  log_throttled("other message", reason);
}

void StatusReporter::log_throttled(const std::string& kind, const std::string& reason) {
  last_error_ = shortened(reason);
  if (const auto line = complaints_.admit(kind, last_error_, Clock::now())) log_line(LogLevel::kWarning, *line);
}

void StatusReporter::set_last_error(const std::string& reason) {
  const std::lock_guard<std::mutex> lock(mutex_);
  last_error_ = shortened(reason);
}

status_t StatusReporter::message() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  const Clock::time_point now = Clock::now();
  const auto last_second =
      std::count_if(recent_.begin(), recent_.end(), [&](const Finished& f) { return f.time > now - kPeriod; });
  std::vector<double> latencies;
  for (const Finished& finished : recent_) latencies.push_back(finished.latency_ms);
  const Percentiles latency = percentiles(std::move(latencies));
  status_t status{};
  status.utime = utime_now();
  status.process = process_;
  status.pid = static_cast<std::int32_t>(getpid());
  status.rate_hz = static_cast<float>(last_second);
  status.frames_received = received_;
  status.frames_processed = processed_;
  status.frames_skipped = skipped_;
  status.frames_lost = -1;
  for (const auto& [source, count] : sequences_) {
    if (count.lost()) status.frames_lost = std::max<std::int64_t>(status.frames_lost, 0) + *count.lost();
  }
  status.frames_refused = refused_;
  status.latency_p50_ms = static_cast<float>(latency.p50);
  status.latency_p95_ms = static_cast<float>(latency.p95);
  status.latency_p99_ms = static_cast<float>(latency.p99);
  status.last_error = last_error_;
  return status;
}

void StatusReporter::note_outage(const LcmBus& bus) {
  const std::string outage = bus.last_outage();
  const std::lock_guard<std::mutex> lock(mutex_);
  if (outage == outage_) return;
  outage_ = outage;
  last_error_ = outage;
}

void StatusReporter::publish(LcmBus& bus) {
  note_outage(bus);
  if (!objects_) {
    bus.publish(channel::kStatus, message());
    return;
  }
  const KnownObjects known = objects_();
  if (!known.problem.empty()) set_last_error(known.problem);
  const status_t status = message();
  known_objects_t objects = to_message(known);
  objects.utime = status.utime;
  objects.process = status.process;
  objects.pid = status.pid;
  bus.publish(channel::kStatus, status);
  bus.publish(channel::kKnownObjects, objects);
}

bool StatusReporter::publish_if_due(LcmBus& bus) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (Clock::now() - last_published_ < kPeriod) return false;
    last_published_ = Clock::now();
  }
  publish(bus);
  return true;
}

bool StatusReporter::try_publish_if_due(LcmBus& bus) {
  try {
    return publish_if_due(bus);
  } catch (const std::exception& error) {
    const std::lock_guard<std::mutex> lock(mutex_);
    log_throttled("status", fmt::format("no status: {}", error.what()));
    return false;
  }
}

std::string StatusReporter::summary() const {
  const status_t status = message();
  const std::string lost = status.frames_lost < 0 ? "unknown" : std::to_string(status.frames_lost);
  std::string line = fmt::format("{} received, {} processed, {} skipped, {} lost, {} refused", status.frames_received,
                                 status.frames_processed, status.frames_skipped, lost, status.frames_refused);
  const std::lock_guard<std::mutex> lock(mutex_);
  if (duplicates_ > 0) line += fmt::format("; {} duplicates dropped", duplicates_);
  return bad_messages_ == 0 ? line : line + fmt::format("; {} other bad messages", bad_messages_);
}

}  // namespace houghstream
