#include "tools/capture/publish_frames.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/host_clock.hpp"
#include "pipeline/base/service_notice.hpp"
#include "pipeline/base/stop_signal.hpp"
#include "pipeline/bus/event_log.hpp"
#include "pipeline/bus/lcm_bus.hpp"
#include "pipeline/bus/status_reporter.hpp"
#include "pipeline/messages/channels.hpp"
#include "tools/common/progress_line.hpp"

namespace houghstream::capture {
namespace {

using Clock = std::chrono::steady_clock;

/// The source's frames, again and again where wanted, with utimes that never repeat: a frame is known by its utime.
class FrameFeed {
 public:
  FrameFeed(const OpenSource& open, const CaptureSettings& settings, openni::CameraListener listener)
      : open_(open), settings_(settings), listener_(std::move(listener)) {
    source_ = open_(listener_);
    require(!source_->is_live() || !settings.rate_hz,
            "--rate is for recordings; a camera's rate belongs to its --mode");
    require(!source_->is_live() || !settings.loop, "--loop is for recordings; a camera has no end");
    rate_hz_ = settings.rate_hz.value_or(source_->rate_hz());
    constexpr double kMinHz = 1e-3;  // no clock counts the periods of the smallest numbers
    require(std::isfinite(rate_hz_) && rate_hz_ >= kMinHz && rate_hz_ <= 1000.0, "rate of {} Hz, expected {} to 1000",
            rate_hz_, kMinHz);
  }

  std::optional<RgbdFrame> next() {
    if (stop_requested() || (settings_.frames && count_ >= *settings_.frames)) return std::nullopt;
    std::optional<RgbdFrame> frame = source_->next();
    if (!frame && stop_requested()) return std::nullopt;
    if (!frame && settings_.loop && count_ > 0) frame = start_again();
    require(frame.has_value() || count_ > 0, "the source has no frames");
    if (!frame) return std::nullopt;
    frame->id.utime += offset_us_;
    if (count_ == 0) first_utime_ = frame->id.utime;
    // A recording that is played at another rate than its own gets the times of that rate, since a speed is a distance
    // over the time between stamps.
    if (is_other_rate()) frame->id.utime = first_utime_ + std::llround(static_cast<double>(count_) * period_us());
    last_utime_ = frame->id.utime;
    ++count_;
    return frame;
  }

  std::int64_t count() const { return count_; }
  std::int64_t first_utime() const { return first_utime_; }
  bool is_live() const { return source_->is_live(); }
  double period_us() const { return 1e6 / rate_hz_; }

 private:
  bool is_other_rate() const { return settings_.rate_hz && *settings_.rate_hz != source_->rate_hz(); }

  std::optional<RgbdFrame> start_again() {
    source_.reset();
    source_ = open_(listener_);
    offset_us_ = last_utime_ - first_utime_ + std::llround(1e6 / source_->rate_hz());
    return source_->next();
  }

  const OpenSource& open_;
  const CaptureSettings& settings_;
  openni::CameraListener listener_;
  std::unique_ptr<FrameSource> source_;
  double rate_hz_ = 0.0;
  std::int64_t count_ = 0;
  std::int64_t first_utime_ = 0;
  std::int64_t last_utime_ = 0;
  std::int64_t offset_us_ = 0;
};

/// Waits for each frame's turn. A source that is late is not made up for: a burst would be lost on the way.
class Pace {
 public:
  Pace(double period_us, Heartbeat& heart)
      : period_(std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double, std::micro>(period_us))),
        heart_(heart) {}

  /// False where a stop signal comes first: at low rates a turn is seconds away.
  bool wait() {
    const Clock::time_point now = Clock::now();
    due_ = now - due_ > period_ ? now : due_;
    while (Clock::now() < due_) {
      heart_.beat();
      if (stop_requested()) return false;
      std::this_thread::sleep_until(std::min(due_, Clock::now() + kPollInterval));
    }
    due_ += period_;
    return true;
  }

 private:
  static constexpr std::chrono::milliseconds kPollInterval{50};  // maximum delay until a stop signal is noticed

  Clock::duration period_;
  Heartbeat& heart_;
  Clock::time_point due_ = Clock::now();
};

/// Sends the status once a second while it lives: a camera that is gone keeps the publishing thread waiting.
class StatusTicker {
 public:
  StatusTicker(StatusReporter& status, LcmBus& bus, const Heartbeat& work) {
    const BlockStopSignals block;
    thread_ = std::thread([this, &status, &bus, &work] {
      while (running_) {
        // A hung process publishes no status.
        if (work.is_beating() && status.try_publish_if_due(bus)) notify_service("WATCHDOG=1");
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
      }
    });
  }
  ~StatusTicker() {
    running_ = false;
    thread_.join();
  }
  StatusTicker(const StatusTicker&) = delete;
  StatusTicker& operator=(const StatusTicker&) = delete;

 private:
  std::atomic<bool> running_{true};
  std::thread thread_;
};

/// A camera is asked for as long as it does not come, and with each question it is asked whether to stop.
openni::CameraListener listener_of(StatusReporter& status, Heartbeat& heart) {
  const auto beat_and_ask = [&heart] {
    heart.beat();
    return stop_requested();
  };
  return {beat_and_ask, [&](const std::string& reason) { status.set_last_error(reason); },
          [&](std::int64_t number) {
            status.note_number({number, number, 0});
          }};
}

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Writes all frames of a source, each with the time of its capture, or for recordings at the wanted rate.
CaptureResult write_frames(FrameFeed& feed, const CaptureSettings& settings, LogWriter& log) {
  CaptureResult result;
  const Clock::time_point start = Clock::now();
  ProgressLine progress("frames", static_cast<double>(settings.frames.value_or(0)));
  while (const std::optional<RgbdFrame> frame = feed.next()) {
    const std::vector<std::uint8_t> bytes = encode_message(to_message(*frame, settings.format, feed.count() - 1));
    const std::int64_t since_first = std::llround(static_cast<double>(result.frames) * feed.period_us());
    log.write(feed.is_live() ? frame->id.utime : feed.first_utime() + since_first, settings.channel,
              {bytes.data(), bytes.size()});
    ++result.frames;
    result.bytes += static_cast<std::int64_t>(bytes.size());
    progress.add(1.0);
  }
  result.seconds = seconds_since(start);
  return result;
}

}  // namespace

CaptureResult capture_to_network(const OpenSource& open, const CaptureSettings& settings, const std::string& url) {
  channel::require_name(settings.channel);
  LcmBus bus(url);
  require(!bus.is_log(), "{}: frames go to a network; to write a log give --log", url);
  StatusReporter status("hs-capture");
  Heartbeat heart;
  FrameFeed feed(open, settings, listener_of(status, heart));
  const StatusTicker ticker(status, bus, heart);
  Pace pace(feed.period_us(), heart);
  notify_service("READY=1");
  CaptureResult result;
  const std::int64_t run = utime_now();
  const Clock::time_point start = Clock::now();
  while (const std::optional<RgbdFrame> frame = feed.next()) {
    const Clock::time_point read = Clock::now();
    heart.beat();
    status.count_received();
    images_t message = to_message(*frame, settings.format, feed.count() - 1);
    add_run(message, run);
    const std::vector<std::uint8_t> bytes = encode_message(message);
    if (!feed.is_live() && !pace.wait()) break;
    if (!bus.publish(settings.channel, {bytes.data(), bytes.size()}, frame->id.utime)) {
      status.count_skipped(1);
      continue;
    }
    status.count_processed(Clock::now() - read);
    ++result.frames;
    result.bytes += static_cast<std::int64_t>(bytes.size());
  }
  bus.publish(channel::kStatus, status.message());
  result.seconds = seconds_since(start);
  return result;
}

CaptureResult capture_to_log(const OpenSource& open, const CaptureSettings& settings, const std::string& file) {
  channel::require_name(settings.channel);
  FrameFeed feed(open, settings, {stop_requested, {}, {}});
  LogWriter log(file, existing_of_recording(settings.replace));
  try {
    CaptureResult result = write_frames(feed, settings, log);
    log.close();
    result.written = log.file().string();
    return result;
  } catch (const std::exception& error) {
    if (!feed.is_live()) throw;
    log.keep_partial();  // a camera's recording cannot be repeated
    fail("{}; what was recorded until then is in {} (hs-log filter makes a log of it)", error.what(),
         log.partial().string());
  }
}

}  // namespace houghstream::capture
