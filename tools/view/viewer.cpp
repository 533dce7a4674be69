#include "tools/view/viewer.hpp"

#include <chrono>
#include <opencv2/core/utility.hpp>
#include <optional>

#include "pipeline/base/log_line.hpp"
#include "pipeline/base/service_notice.hpp"
#include "pipeline/base/stop_signal.hpp"
#include "pipeline/base/thread_priority.hpp"
#include "tools/view/bus_watcher.hpp"
#include "tools/view/foxglove/live_foxglove.hpp"

namespace houghstream::view {
namespace {

using Clock = std::chrono::steady_clock;

// Lowers the priority of drawing and of the threads that it starts later (the video encoder's), not of the one that
// receives. One thread draws: several that share so little work spend more time on waking than they save.
void step_back() {
  cv::setNumThreads(1);
  yield_to_results("drawing");
}

// Returns how many frames may wait: files leave time after the stream, while in a window and on a page only the newest
// matters.
std::size_t waiting_frames(const FrameRendererSettings& settings) {
  constexpr std::size_t kForFiles = 50;
  return settings.writes() ? kForFiles : 1;
}

LiveFoxgloveSettings foxglove_settings(const ViewerSettings& settings) {
  LiveFoxgloveSettings foxglove;
  foxglove.address = settings.show.foxglove;
  foxglove.names = settings.show.http_hosts;
  foxglove.frame_channels = settings.frame_channels;
  foxglove.camera = settings.show.camera;
  return foxglove;
}

}  // namespace

void run_viewer(const ViewerSettings& settings) {
  FrameRenderer frame_show(settings.show, settings.lcm_url);
  catch_stop_signals();
  MatchSettings match;
  match.rate_hz = settings.show.outputs.rate_hz;
  LcmBus bus(settings.lcm_url);
  std::optional<LiveFoxglove> foxglove;  // before the watcher, which handles the bus
  if (!settings.show.foxglove.empty())
    foxglove.emplace(bus, foxglove_settings(settings), [&frame_show] { return frame_show.models(); });
  BusWatcher watcher(bus, settings.frame_channels, match, waiting_frames(settings.show));
  // On a busy machine, and with a long video, the end takes longer than the caller of this program would wait.
  std::optional<StillFinishing> finishing;
  if (settings.show.writes()) finishing.emplace(StillFinishing::From::kStopSignal);
  step_back();
  log_info("ready: watching {}", settings.frame_channels);

  const auto start = Clock::now();
  const std::chrono::duration<double> limit(settings.duration);
  while (!stop_requested() && !frame_show.complete() && (settings.duration <= 0.0 || Clock::now() - start < limit)) {
    if (const auto matched = watcher.next(std::chrono::milliseconds(20))) frame_show.show(*matched, watcher);
    if (!frame_show.handle_keys(watcher)) break;
  }
  watcher.stop();
  while (const auto matched = watcher.next(std::chrono::milliseconds(0))) frame_show.show(*matched, watcher);
  frame_show.finish();  // before the last word, which a bus that is gone does not take: a video must be whole
  watcher.finish();
}

}  // namespace houghstream::view
