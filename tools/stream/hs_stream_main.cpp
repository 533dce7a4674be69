#include <fmt/format.h>

#include <cstdlib>
#include <memory>
#include <optional>
#include <thread>

#include "drivers/store/practice_record.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/base/stop_signal.hpp"
#include "pipeline/bus/lcm_bus.hpp"
#include "pipeline/messages/channels.hpp"
#include "tools/common/tool_main.hpp"
#include "tools/common/usage_error.hpp"
#include "tools/stream/state_board.hpp"
#include "tools/stream/stream_plan.hpp"

namespace houghstream::stream {
namespace {

/// Seconds.
struct Pace {
  double every = 5.0;            ///< seconds between two lines of state
  double stop_timeout = 1.5;     ///< seconds for the processes to end by themselves
  double hang_timeout = 10.0;    ///< seconds without a heartbeat after which a process hangs
  double start_patience = 60.0;  ///< seconds until the first heartbeat
};

void add_options(CommandLine& app, StreamOptions& options, Pace& pace) {
  app.add_option(
      "--source", options.source,
      "as of hs-capture; without it others send frames. Several cameras: 'LEFT=openni2:#1 RIGHT=openni2:#2'");
  app.add_option("--objects", options.objects, "object store of hs-teach");
  app.add_option("--forest", options.forest, "forest file of hs-train, instead of --objects");
  app.add_option("--models", options.models, "with --forest: models folder, for poses");
  app.add_option("--camera", options.camera, "WIDTHxHEIGHT,fx,fy,cx,cy where frames carry none");
  app.add_option("--cameras", options.cameras, "YAML file of where cameras stand, as of hs-track");
  app.add_option("-c,--channel", options.channel, "channel of the frames").capture_default_str();
  app.add_option("--threshold", options.threshold, "smallest score that is reported").range(0.0, 1.0);
  app.add_option("--min-quality", options.min_quality, "smallest quality of a valid pose").range(0.0, 1.0);
  app.add_option("--precision", options.precision, "with --objects: fraction that shall be right")
      .range(0.0, store::kMaxPrecision)
      .excludes(app.get_option("--threshold"))
      .excludes(app.get_option("--min-quality"));
  app.add_clearing_flag("--no-view", options.view, "no window");
  app.add_flag("--follow", options.follow,
               "poses for each frame at once: hs-pose --follow, and hs-detect --looks-per-second 5 unless "
               "--detect-options say how many");
  app.add_flag("--track", options.track, "hs-track too: objects on HOUGHSTREAM_OBJECTS");
  app.add_option("--capture-options", options.capture_options,
                 "further options for hs-capture, with quotes as in a shell: '--loop --record \"my file.oni\"'");
  app.add_option("--detect-options", options.detect_options, "further options for hs-detect");
  app.add_option("--pose-options", options.pose_options, "further options for hs-pose");
  app.add_option("--track-options", options.track_options, "further options for hs-track");
  app.add_option("--view-options", options.view_options, "further options for hs-view");
  app.add_option("--every", pace.every, "seconds between two lines of state").range(0.1, 3600.0).capture_default_str();
  app.add_option("--patience", pace.stop_timeout,
                 "seconds in which to end; who says that it writes the end of a file gets ten minutes")
      .range(0.1, 600.0)
      .capture_default_str();
  app.add_option("--hang-patience", pace.hang_timeout, "seconds without a status until it is restarted")
      .range(2.0, 3600.0)
      .capture_default_str();
  app.add_option("--start-patience", pace.start_patience, "the same for one that has sent none so far")
      .range(2.0, 3600.0)
      .capture_default_str();
  add_lcm_url_option(app, options.lcm_url);
}

bool has_display() {
  return std::getenv("DISPLAY") != nullptr || std::getenv("WAYLAND_DISPLAY") != nullptr;
}

template <typename Duration>
Duration from_seconds(double seconds) {
  return std::chrono::duration_cast<Duration>(std::chrono::duration<double>(seconds));
}

/// Receives the statuses of the processes. A bus that goes away does not end the stream.
class StatusEar {
 public:
  /// Waits for the bus. Throws InputError where it cannot be opened.
  explicit StatusEar(const std::string& url) : bus_(url) {
    require(!bus_.is_log(), "{}: is a log; the stream runs on a network", bus_.url());
  }

  /// Subscribes to the bus. Processes that were started before do not inherit the receiving sockets.
  void hear(LcmBus::Handler handler) { bus_.subscribe(channel::kStatus, std::move(handler)); }

  /// Hands on one message, or waits for `timeout`. False while nothing can be heard.
  bool listen(std::chrono::milliseconds timeout) {
    bus_.handle(timeout);
    return bus_.is_reachable();
  }

 private:
  LcmBus bus_;
};

/// Until what the source has sent last has gone through all others, and no longer than they are worth waiting for.
void await_last_frames(StatusEar& ear, const DrainMonitor& last_frames) {
  const auto end = DrainMonitor::Clock::now() + DrainMonitor::kTimeout;
  while (!stop_requested() && !last_frames.is_drained() && DrainMonitor::Clock::now() < end)
    ear.listen(std::chrono::milliseconds(20));
  if (!last_frames.is_drained() && !stop_requested())
    log_warning("the stream ends, though not all processes have said that the last frames went through them");
}

void run_stream(StreamOptions options, const Pace& pace) {
  require_usage(options.objects.empty() != options.forest.empty(), "expected either --objects STORE or --forest FILE");
  require_usage(!options.precision || !options.objects.empty(),
                "--precision goes with --objects, whose practice it reads");
  require_usage(options.objects.empty() || options.models.empty(),
                "--models goes with --forest; --objects has its own");
  options.executables = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  if (options.view && options.view_options.empty() && !has_display()) {
    log_warning(
        "no display: without hs-view; --view-options '--http 8080' serves a page, '--video FILE.mp4' writes a video");
    options.view = false;
  }
  catch_stop_signals();
  StatusEar ear(options.lcm_url);
  SupervisorSettings settings;
  settings.stop_timeout = from_seconds<std::chrono::milliseconds>(pace.stop_timeout);
  settings.heartbeat_timeout = from_seconds<std::chrono::milliseconds>(pace.hang_timeout);
  settings.startup_timeout = from_seconds<std::chrono::milliseconds>(pace.start_patience);
  Supervisor supervisor(plan_stream(options), settings, [](const std::string& words) { log_info("{}", words); });
  StatusBoard board;
  std::optional<DrainMonitor> last_frames;
  ear.hear([&](const ReceivedMessage& arrival) {
    const auto status = decode_message<status_t>(arrival.bytes);
    if (!supervisor.on_heartbeat(status.pid)) return;
    board.note(status, arrival.time);
    if (last_frames) last_frames->note(status, arrival.time);
  });
  const auto period = from_seconds<StatusBoard::Clock::duration>(pace.every);
  auto due = StatusBoard::Clock::now() + period;
  while (!stop_requested() && supervisor.step()) {
    if (!ear.listen(std::chrono::milliseconds(20))) supervisor.pause_watchdog();
    if (StatusBoard::Clock::now() < due) continue;
    due += period;
    board.keep(supervisor.states());
    log_info("{}", board.line(supervisor.states(), StatusBoard::Clock::now()));
  }
  await_last_frames(ear, last_frames.emplace(supervisor.downstream_pids(), DrainMonitor::Clock::now()));
  for (const std::string& name : supervisor.stop()) log_warning("{} did not end when asked and was killed", name);
  log_info("all ended");
}

}  // namespace
}  // namespace houghstream::stream

int main(int argc, char** argv) {
  using namespace houghstream;
  using namespace houghstream::stream;
  CommandLine app(
      "Starts capture, detection, poses and view, shows their state, starts again what dies or hangs. Ends on Ctrl-C, "
      "at the source's end, when the window closes.",
      "hs-stream");
  StreamOptions options;
  Pace pace;
  add_options(app, options, pace);
  app.add_config_file();
  app.add_example("hs-stream --source openni2 --objects my.store");
  app.add_example("hs-stream --source bop:SCENE --capture-options=--loop --objects my.store");
  CommandLine init = app.add_subcommand("init", "prints a file for --config, with what options do");
  init.add_example("hs-stream init > stream.toml");
  return run_tool(app, argc, argv, [&] {
    if (init.given()) {
      fmt::print("{}", app.config_template());
      return;
    }
    run_stream(options, pace);
  });
}
