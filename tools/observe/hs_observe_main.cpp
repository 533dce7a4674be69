#include <functional>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/base/stop_signal.hpp"
#include "pipeline/bus/channel_pattern.hpp"
#include "pipeline/bus/lcm_bus.hpp"
#include "pipeline/messages/channels.hpp"
#include "tools/common/new_output.hpp"
#include "tools/common/tool_main.hpp"
#include "tools/observe/frame_times.hpp"

namespace {

using namespace houghstream;
using Clock = std::chrono::steady_clock;

struct ObserveOptions {
  std::string url;
  std::string frame_channels = channel::kFrame;
  std::string out;
  std::string csv;
  bool replace = false;
  double duration_s = 1e9;
  double quiet_s = 2.5;  // timeout longer than the status period, so that the last word of each process is in
  std::optional<std::int64_t> expect;
};

void write_file(const std::string& file, const std::string& text) {
  if (file.empty()) return;
  write_file_atomically(file, text);
}

/// Handles messages until `done`. Returns what stopped the bus before, for what has come until then is written first.
std::string receive(LcmBus& bus, const std::function<bool()>& done) {
  try {
    while (!stop_requested() && !done()) bus.handle(std::chrono::milliseconds(100));
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

void observe(const ObserveOptions& options) {
  for (const std::string& file : {options.out, options.csv}) {
    if (file.empty()) continue;
    require_writable(file);
    require_new_output(file, options.replace);
  }
  catch_stop_signals();
  LcmBus bus(options.url);
  require(!bus.is_log(), "{}: a log is observed by replaying it with lcm-logplayer, expected a network URL", bus.url());
  FrameTimes times;
  Clock::time_point last = Clock::now();
  // Only the frame's name is read: the observer must cost the observed next to nothing.
  const ChannelPattern channels(options.frame_channels);
  bus.subscribe_to_frames(options.frame_channels, [&](const ReceivedMessage& arrival) {
    if (!channels.is_name() && !is_frame_message(arrival.bytes)) return;
    times.note_frame({arrival.channel, read_utime(arrival.bytes, arrival.channel)}, arrival.time);
    last = arrival.time;
  });
  const auto stamp = [&](const std::string& name, void (FrameTimes::*note)(const FrameId&, FrameTimes::Time)) {
    bus.subscribe(name, [&, note](const ReceivedMessage& arrival) {
      const FrameId frame = read_result_frame(arrival.bytes, arrival.channel);
      if (!channels.matches(frame.channel)) return;
      (times.*note)(frame, arrival.time);
      last = arrival.time;
    });
  };
  stamp(channel::kDetections, &FrameTimes::note_detections);
  stamp(channel::kPoses, &FrameTimes::note_poses);
  stamp(channel::kObjects, &FrameTimes::note_objects);
  bus.subscribe(channel::kStatus,
                [&](const ReceivedMessage& a) { times.note_status(decode_message<status_t>(a.bytes)); });
  log_info("ready: at {}", bus.url());

  const Clock::time_point start = Clock::now();
  const auto since = [](Clock::time_point t) { return std::chrono::duration<double>(Clock::now() - t).count(); };
  const auto complete = [&] {
    return options.expect && static_cast<std::int64_t>(times.frames()) >= *options.expect &&
           since(last) > options.quiet_s;
  };
  const std::string failure = receive(bus, [&] { return since(start) >= options.duration_s || complete(); });
  write_file(options.csv, times.csv());
  // A process's name and last error may hold any bytes; JSON holds Unicode only.
  const std::string summary =
      times.summary(options.expect).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  write_file(options.out, summary);
  if (options.out.empty()) std::fputs(summary.c_str(), stdout);
  require(failure.empty(), "{}; what came before is written", failure);
}

}  // namespace

int main(int argc, char** argv) {
  CommandLine app("Stamps the arrival of frames, detections, poses and objects on the bus, and adds up", "hs-observe");
  ObserveOptions options;
  app.add_option("--out", options.out, "write the summary to this JSON file instead of stdout");
  app.add_option("--csv", options.csv, "write one row for each frame to this file");
  houghstream::add_replace_output_option(app, options.replace, "files of the names of --out and --csv");
  app.add_option("--duration", options.duration_s, "end after this many seconds; default: at a stop signal")
      .non_negative();
  app.add_option("--expect", options.expect, "frames that are sent; end when they have come and the bus is quiet")
      .non_negative();
  app.add_option("--quiet", options.quiet_s, "how long quiet is, seconds").non_negative().capture_default_str();
  add_frame_channels_option(app, options.frame_channels);
  houghstream::add_lcm_url_option(app, options.url);
  app.add_example("hs-observe --duration 60 --csv frames.csv");
  return houghstream::run_tool(app, argc, argv, [&] { observe(options); });
}
