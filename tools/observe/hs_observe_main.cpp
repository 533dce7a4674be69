#include <fstream>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/base/stop_signal.hpp"
#include "pipeline/bus/channels.hpp"
#include "pipeline/bus/lcm_bus.hpp"
#include "tools/common/tool_main.hpp"
#include "tools/observe/frame_times.hpp"

namespace {

using namespace houghstream;
using Clock = std::chrono::steady_clock;

struct ObserveOptions {
  std::string url;
  std::string frame_channel = channel::kFrame;
  std::string out;
  std::string csv;
  double duration_s = 1e9;
  double quiet_s = 2.5;  // longer than the status period, so that the last word of each process is in
  std::optional<std::int64_t> expect;
};

void write_file(const std::string& file, const std::string& text) {
  if (file.empty()) return;
  std::ofstream out(file);
  out << text << std::flush;
  require(out.good(), "{}: cannot be written", file);
}

void observe(const ObserveOptions& options) {
  catch_stop_signals();
  LcmBus bus(options.url);
  FrameTimes times;
  Clock::time_point last = Clock::now();
  // Only the utime is read: the observer must cost the observed next to nothing.
  const auto stamp = [&](const std::string& name, void (FrameTimes::*note)(std::int64_t, FrameTimes::Time)) {
    bus.subscribe(name, [&, note](const Arrival& arrival) {
      (times.*note)(read_utime(arrival.bytes, arrival.channel), arrival.time);
      last = arrival.time;
    });
  };
  stamp(options.frame_channel, &FrameTimes::note_frame);
  stamp(channel::kDetections, &FrameTimes::note_detections);
  stamp(channel::kPoses, &FrameTimes::note_poses);
  bus.subscribe(channel::kStatus, [&](const Arrival& a) { times.note_status(decode_message<status_t>(a.bytes)); });
  log_info("ready: at {}", bus.url());

  const Clock::time_point start = Clock::now();
  const auto since = [](Clock::time_point t) { return std::chrono::duration<double>(Clock::now() - t).count(); };
  const auto complete = [&] {
    return options.expect && static_cast<std::int64_t>(times.frames()) >= *options.expect &&
           since(last) > options.quiet_s;
  };
  while (!stop_requested() && since(start) < options.duration_s && !complete()) {
    bus.handle(std::chrono::milliseconds(100));
  }
  write_file(options.csv, times.csv());
  const std::string summary = times.summary(options.expect).dump(2) + "\n";
  write_file(options.out, summary);
  if (options.out.empty()) std::fputs(summary.c_str(), stdout);
}

}  // namespace

int main(int argc, char** argv) {
  CommandLine app("Stamps the arrival of frames, detections and poses on the bus, and adds up", "hs-observe");
  ObserveOptions options;
  app.add_option("--out", options.out, "write the summary to this JSON file instead of stdout");
  app.add_option("--csv", options.csv, "write one row for each frame to this file");
  app.add_option("--duration", options.duration_s, "end after this many seconds; default: at a stop signal");
  app.add_option("--expect", options.expect, "frames that are sent; end when they have come and the bus is quiet");
  app.add_option("--quiet", options.quiet_s, "how long quiet is, seconds").capture_default_str();
  app.add_option("-c,--channel", options.frame_channel, "channel of the frames").capture_default_str();
  houghstream::add_lcm_url_option(app, options.url);
  return houghstream::run_tool(app, argc, argv, [&] { observe(options); });
}
