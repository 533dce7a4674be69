#include "tools/teach/show/show_sources.hpp"

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>

#include "drivers/datasets/open_frame_source.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/base/stop_signal.hpp"
#include "pipeline/messages/messages.hpp"
#include "tools/capture/capture_options.hpp"
#include "tools/log/recording.hpp"

namespace houghstream::teach {
namespace {

bool starts_with(const std::string& text, const std::string& start) {
  return text.rfind(start, 0) == 0;
}

/// Limits the length of a camera's take by a steady clock: frames may stop arriving, and a disconnected camera is
/// awaited no longer than the take.
class TakeTime {
 public:
  explicit TakeTime(double max_duration_s) : max_s_(max_duration_s) {}

  /// Begins the take when the camera is open; its first frame may need longer than a short take.
  void open() { end_ = after(std::max(max_s_, kFirstFrameS)); }
  void note_first_frame() { end_ = after(max_s_ + kLateS); }
  bool is_cancelled() const { return end_ && Clock::now() > *end_; }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr double kFirstFrameS = 10.0;
  static constexpr double kLateS = 0.5;  // frames end by their own times where they come

  static Clock::time_point after(double seconds) {
    return Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  }

  double max_s_;
  std::optional<Clock::time_point> end_;
};

/// A camera's frames come at their own time; a take of them has an end.
class LiveFrames {
 public:
  LiveFrames(const std::string& source, const ShowOptions& options)
      : time_(options.max_duration_s), max_us_(static_cast<std::int64_t>(1e6 * options.max_duration_s)) {
    capture::SourceOptions camera;
    camera.source = source;
    camera.camera = options.camera;
    openni::CameraListener listener;
    listener.stop_requested = [this] { return stop_requested() || time_.is_cancelled(); };
    source_ = capture::open_source(camera, listener);
    time_.open();
  }
  LiveFrames(const LiveFrames&) = delete;  // the camera asks this one
  LiveFrames& operator=(const LiveFrames&) = delete;

  std::optional<RgbdFrame> next() {
    if (stop_requested()) return std::nullopt;
    std::optional<RgbdFrame> frame = source_->next();
    if (!frame) {
      if (!stop_requested())
        log_warning("the take ends by its time, {} s, while no frames come; it has {}",
                    1e-6 * static_cast<double>(max_us_), count_);
      return frame;
    }
    if (count_ == 0) time_.note_first_frame();
    ++count_;
    // A clock that is set back begins the take anew, instead of making it longer by so much.
    if (!first_ || frame->id.utime < *first_) first_ = frame->id.utime;
    if (microseconds_between(*first_, frame->id.utime) > max_us_) return std::nullopt;
    return frame;
  }

 private:
  TakeTime time_;
  std::int64_t max_us_;
  std::unique_ptr<FrameSource> source_;
  std::optional<std::int64_t> first_;
  std::int64_t count_ = 0;
};

/// Frames of a log or a recorder's file, with what was lost of it said at the end.
class RecordedFrames {
 public:
  explicit RecordedFrames(const log_tools::RecordingSettings& settings) : next_(open_recording(settings, losses_)) {}

  std::optional<RgbdFrame> next() {
    if (const std::optional<log_tools::RecordedFrame> frame = next_())
      return frame_from_message(frame->message, frame->channel, std::nullopt);
    if (const std::string line = losses_.line(); !line.empty()) log_warning("{}", line);
    return std::nullopt;
  }

 private:
  log_tools::LossReport losses_;
  log_tools::NextFrame next_;
};

}  // namespace

ShownFrames open_shown(const std::string& source, const ShowOptions& options) {
  if (starts_with(source, "openni2")) {
    catch_stop_signals();
    const auto live = std::make_shared<LiveFrames>(source, options);
    log_info("ready: frames from {}; Ctrl-C ends the take", source);
    return [live] { return live->next(); };
  }
  for (const char* kind : {"bop:", "uw:", "tum:", "bag:"}) {
    if (!starts_with(source, kind)) continue;
    require(options.camera.empty(), "--camera goes with frames that come without, not with {}", source);
    const std::shared_ptr<FrameSource> frames = open_frame_source(source);
    return [frames] { return frames->next(); };
  }
  log_tools::RecordingSettings settings;
  settings.source = starts_with(source, "log:") ? source.substr(4) : source;
  settings.channel = options.channel;
  if (!options.camera.empty()) settings.camera = parse_camera(options.camera);
  const auto recorded = std::make_shared<RecordedFrames>(settings);
  return [recorded] { return recorded->next(); };
}

bool is_live(const std::string& source) {
  return source.rfind("openni2", 0) == 0 || source.rfind("stream:", 0) == 0;
}

std::optional<RgbdFrame> CameraTake::next() {
  std::optional<RgbdFrame> frame;
  if (!is_over_) frame = frames_();
  if (!frame) release_stop_signals();
  return frame;
}

void CameraTake::progress(const ShowProgress& now) {
  if (now.state == TeachingState::kTracking && is_covered_(now)) is_over_ = true;
  if (observer_ != nullptr) observer_->progress(now);
}

}  // namespace houghstream::teach
