#include "drivers/datasets/open_frame_source.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/base/stop_signal.hpp"
#include "tools/capture/capture_options.hpp"
#include "tools/capture/publish_frames.hpp"
#include "tools/common/tool_main.hpp"
#include "tools/common/usage_error.hpp"

int main(int argc, char** argv) {
  using namespace houghstream;
  using namespace houghstream::capture;
  CommandLine app("Publishes RGB-D frames as images_t, or writes them to an LCM log", "hs-capture");
  SourceOptions source;
  bool list = false;
  bool json = false;
  std::string log;
  std::string url;
  bool raw_colour = false;
  bool raw_depth = false;
  CaptureSettings settings;
  add_source_options(app, source);
  app.add_flag("--list-devices", list, "print the cameras that OpenNI2 finds, and end");
  app.add_flag("--json", json, "with --list-devices: print them as JSON, for scripts");
  app.add_option("--log", log, "write this LCM log instead of publishing");
  add_replace_option(app, settings.replace, "--log or --record");
  app.add_option("--rate", settings.rate_hz, "frames per second; default: the source's; a camera keeps its own")
      .range(1e-3, 1e3);
  app.add_option("--frames", settings.frames, "end after this many frames").positive();
  app.add_flag("--loop", settings.loop, "start again at the end");
  app.add_flag("--raw-colour", raw_colour, "colour as raw RGB instead of JPEG");
  app.add_flag("--raw-depth", raw_depth, "depth as DEPTH_MM instead of DEPTH_MM_ZIPPED");
  app.add_option("--jpeg-quality", settings.format.jpeg_quality, "of the colour").range(1, 100).capture_default_str();
  app.add_option("--zip-level", settings.format.zip_level, "of the depth").range(1, 9).capture_default_str();
  app.add_option("-c,--channel", settings.channel, "channel of the frames").capture_default_str();
  add_lcm_url_option(app, url);
  app.add_example("hs-capture --source openni2");
  app.add_example("hs-capture --source bop:out/demo/data/scene --log scene.lcmlog");

  return run_tool(app, argc, argv, [&] {
    require_usage(list || !json, "--json goes with --list-devices");
    if (list) {
      if (json) return print_json(devices_json());
      std::puts(devices_text().c_str());
      return;
    }
    require_usage(!source.source.empty(), "--source is missing: for instance openni2, oni:FILE or bop:DIR");
    require_outside_source(log, source.source);
    settings.format.jpeg = !raw_colour;
    settings.format.zip_depth = !raw_depth;
    require_usage(log.empty() || !settings.loop || settings.frames, "--loop into a log never ends; give --frames");
    source.live.replace_record = settings.replace;
    catch_stop_signals();
    const OpenSource open = [&](const openni::CameraListener& listener) { return open_source(source, listener); };
    const CaptureResult result =
        log.empty() ? capture_to_network(open, settings, url) : capture_to_log(open, settings, log);
    log_info("{} frames of {:.1f} kB to {}, {:.1f} s, {:.1f} Hz", result.frames,
             static_cast<double>(result.bytes) / static_cast<double>(std::max<std::int64_t>(result.frames, 1)) / 1e3,
             log.empty() ? settings.channel : result.written, result.seconds,
             static_cast<double>(result.frames) / std::max(result.seconds, 1e-9));
  });
}
