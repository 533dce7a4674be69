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

ViewedFrame decode(const MatchedFrame& matched) {
  const ByteView bytes{matched.frame_bytes.data(), matched.frame_bytes.size()};
  ViewedFrame viewed;
  viewed.frame = frame_from_message(decode_message<houghstream::images_t>(bytes), std::nullopt);
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

// A frame that cannot be understood is reported and passed over.
std::optional<cv::Mat> draw(const MatchedFrame& matched, const ClassModels& models, const FrameViewSettings& settings,
                            BusWatcher& watcher) {
  try {
    cv::Mat picture = draw_frame_view(decode(matched), models, settings);
    watcher.note_drawn(matched);
    return picture;
  } catch (const InputError& error) {
    watcher.note_refused(error.what());
    return std::nullopt;
  }
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

}  // namespace

void run_viewer(const ViewerSettings& settings) {
  catch_stop_signals();
  const ClassModels models =
      settings.models.empty() ? ClassModels() : load_class_models(settings.models, settings.model_unit_m);
  const std::unique_ptr<ViewWindow> window = settings.headless() ? nullptr : std::make_unique<ViewWindow>();
  ViewOutputs outputs(settings.outputs);
  FrameViewSettings picture_settings = settings.picture;
  MatchSettings match;
  match.rate_hz = settings.outputs.rate_hz;
  BusWatcher watcher(settings.lcm_url, settings.frame_channel, match, waiting_frames(settings));
  step_back();
  spdlog::info("ready: watching {}", settings.frame_channel);

  const auto show = [&](const MatchedFrame& matched) {
    const std::optional<cv::Mat> picture = draw(matched, models, picture_settings, watcher);
    if (!picture) return;
    outputs.add(*picture, matched.utime, matched.slot);
    if (window) window->show(*picture, matched.utime);
  };
  const auto start = Clock::now();
  const std::chrono::duration<double> limit(settings.duration);
  while (!stop_requested() && !outputs.complete() && (settings.duration <= 0.0 || Clock::now() - start < limit)) {
    if (const auto matched = watcher.next(std::chrono::milliseconds(20))) show(*matched);
    if (window && !window->handle_keys(picture_settings)) break;
  }
  watcher.stop();
  while (const auto matched = watcher.next(std::chrono::milliseconds(0))) show(*matched);
  watcher.finish();
  outputs.finish();
}

}  // namespace houghstream
