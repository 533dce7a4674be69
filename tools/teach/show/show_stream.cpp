#include "tools/teach/show/show_stream.hpp"

#include <sys/resource.h>

#include <filesystem>

#include "pipeline/base/log_line.hpp"
#include "pipeline/base/stop_signal.hpp"
#include "pose/reconstruction/map/view_sphere.hpp"
#include "tools/teach/show/stream_take.hpp"
#include "tools/teach/show/teaching_publisher.hpp"

namespace houghstream::teach {
namespace {

/// Lowers the priority of all threads, on Linux: work after the take delays no frame of the stream.
void let_others_first() {
  constexpr int kPolite = 10;
  std::error_code error;
  for (const auto& thread : std::filesystem::directory_iterator("/proc/self/task", error))
    setpriority(PRIO_PROCESS, static_cast<id_t>(std::stoul(thread.path().filename().string())), kPolite);
}

/// Publishes the progress, and ends the take when enough of the object was observed.
class TakeObserver : public ShowObserver {
 public:
  TakeObserver(LcmBus& bus, StreamTake& take) : publisher_(bus, reconstruction::view_directions()), take_(take) {}

  void progress(const ShowProgress& now) override {
    publisher_.progress(now);
    if (now.state == TeachingState::kChoosing) take_.skip_to_newest();  // until something is chosen, only now counts
    if (now.state == TeachingState::kTracking && is_covered_(now)) take_.end();
  }

 private:
  TeachingPublisher publisher_;
  StreamTake& take_;
  CoverageCriterion is_covered_;
};

/// Ends the take. From here on a stop signal ends the program.
void end_take(const StreamTake& take) {
  if (take.passed_over() > 0) log_warning("{} frames came too fast and were passed over", take.passed_over());
  if (take.refused() > 0) log_warning("{} messages were no frames of the take and were dropped", take.refused());
  release_stop_signals();
  let_others_first();
}

}  // namespace

int show_from_stream(ShowOptions options, const std::string& lcm_url) {
  catch_stop_signals();
  LcmBus bus(lcm_url);
  StreamTakeSettings settings;
  if (!options.channel.empty()) settings.channel = options.channel;
  if (!options.camera.empty()) settings.camera = parse_camera(options.camera);
  settings.max_length = std::chrono::milliseconds(static_cast<std::int64_t>(1e3 * options.max_duration_s));
  StreamTake take(bus, settings);
  TakeObserver observer(bus, take);
  options.source = fmt::format("stream:{}", settings.channel);
  const ShownFrames frames = [&] {
    std::optional<RgbdFrame> frame = take.next();
    if (!frame) end_take(take);
    return frame;
  };
  log_info("ready: frames from {} at {}; Ctrl-C ends the take", settings.channel, bus.url());
  return show_object(options, frames, {}, &observer);
}

}  // namespace houghstream::teach
