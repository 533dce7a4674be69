#include "tools/view/viewer.hpp"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <chrono>
#include <memory>
#include <optional>

#include "drivers/bop_dataset.hpp"
#include "pipeline/checks.hpp"
#include "pipeline/messages.hpp"
#include "pipeline/stop_signal.hpp"
#include "pipeline/wire_check.hpp"
#include "tools/view/bus_watcher.hpp"
#include "tools/view/view_window.hpp"

namespace houghstream {
namespace {

using Clock = std::chrono::steady_clock;

ViewedFrame decode(const MatchedFrame& matched, const std::optional<Camera>& camera) {
  const ByteView bytes{matched.frame_bytes.data(), matched.frame_bytes.size()};
  ViewedFrame viewed;
  viewed.frame = frame_from_message(decode_message<houghstream::images_t>(bytes), camera);
  viewed.detections.utime = matched.utime;
  if (matched.detections) {
    viewed.detections = *matched.detections;
    viewed.detect_latency_ms = matched.detect_latency_ms;
  }
  if (matched.poses) {
    viewed.poses = matched.poses;
    viewed.pose_latency_ms = matched.pose_latency_ms;
  }
  return viewed;
}

// Drawing yields to the stream: on a busy machine pictures are late, results are not. On Linux this holds for the
// calling thread and those that it starts later (the video encoder's), not for the one that receives.
void step_back() {
  constexpr int kPolite = 15;
  if (nice(kPolite) == -1) spdlog::warn("the priority of drawing cannot be lowered");
}

// Without a window there is time after the stream: frames may wait. In a window only the newest matters.
std::size_t waiting_frames(const ViewerSettings& settings) {
  constexpr std::size_t kWithoutWindow = 50;
  return settings.headless() ? kWithoutWindow : 1;
}

// The frame that is shown, and how the stream went until it.
class FrameShow {
 public:
  explicit FrameShow(const ViewerSettings& settings)
      : models_(settings.models.empty() ? ClassModels() : load_class_models(settings.models, settings.model_unit_m)),
        window_(settings.headless() ? nullptr : std::make_unique<ViewWindow>()),
        outputs_(settings.outputs),
        camera_(settings.camera),
        picture_settings_(settings.picture),
        preview_(settings.preview) {
    picture_settings_.show_keys = window_ != nullptr;
  }

  // Shows a frame, unless paused.
  void show(const MatchedFrame& matched, BusWatcher& watcher) {
    if (picture_settings_.paused) {
      watcher.note_skipped();
      return;
    }
    const std::optional<cv::Mat> picture = drawn(matched, watcher);
    if (!picture) return;
    if (window_) window_->show(*picture, matched.utime);
    outputs_.add(*picture, matched.utime, matched.slot);
    if (preview_) watcher.publish_preview(*picture, matched.utime);
  }

  // False when the window was asked to end.
  bool handle_keys() {
    if (!window_) return true;
    const KeyAction action = window_->handle_keys(picture_settings_);
    if (action == KeyAction::kRedraw && viewed_) window_->show(draw(*viewed_), viewed_->frame.utime);
    return action != KeyAction::kEnd;
  }

  bool complete() const { return outputs_.complete(); }
  void finish() { outputs_.finish(); }

 private:
  // A frame that cannot be understood is reported and passed over.
  std::optional<cv::Mat> drawn(const MatchedFrame& matched, BusWatcher& watcher) {
    try {
      ViewedFrame viewed = decode(matched, camera_);
      remember(viewed);
      stream_.state = watcher.stream_state();
      stream_.frames_lost = watcher.frames_lost();
      cv::Mat picture = draw(viewed);
      viewed_ = std::move(viewed);
      watcher.note_drawn(matched);
      return picture;
    } catch (const InputError& error) {
      watcher.note_refused(error.what());
      return std::nullopt;
    }
  }

  cv::Mat draw(const ViewedFrame& viewed) const { return draw_frame_view(viewed, models_, picture_settings_, stream_); }

  void remember(const ViewedFrame& viewed) {
    constexpr std::size_t kFrames = 200;
    if (viewed.poses) {
      stream_.history.push_back({viewed.poses->stages, viewed.pose_latency_ms});
    } else {
      stream_.history.push_back({viewed.detections.stages, viewed.detect_latency_ms});
    }
    if (stream_.history.size() > kFrames) stream_.history.pop_front();
  }

  ClassModels models_;
  std::unique_ptr<ViewWindow> window_;
  ViewOutputs outputs_;
  std::optional<Camera> camera_;
  FrameViewSettings picture_settings_;
  bool preview_;
  std::optional<ViewedFrame> viewed_;
  StreamView stream_;
};

}  // namespace

void run_viewer(const ViewerSettings& settings) {
  catch_stop_signals();
  FrameShow frame_show(settings);
  MatchSettings match;
  match.rate_hz = settings.outputs.rate_hz;
  BusWatcher watcher(settings.lcm_url, settings.frame_channel, match, waiting_frames(settings));
  step_back();
  spdlog::info("ready: watching {}", settings.frame_channel);

  const auto start = Clock::now();
  const std::chrono::duration<double> limit(settings.duration);
  while (!stop_requested() && !frame_show.complete() && (settings.duration <= 0.0 || Clock::now() - start < limit)) {
    if (const auto matched = watcher.next(std::chrono::milliseconds(20))) frame_show.show(*matched, watcher);
    if (!frame_show.handle_keys()) break;
  }
  watcher.stop();
  while (const auto matched = watcher.next(std::chrono::milliseconds(0))) frame_show.show(*matched, watcher);
  watcher.finish();
  frame_show.finish();
}

}  // namespace houghstream
