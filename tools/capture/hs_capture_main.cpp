#include <spdlog/spdlog.h>

#include "pipeline/checks.hpp"
#include "pipeline/stop_signal.hpp"
#include "tools/capture/publish_frames.hpp"
#include "tools/common/tool_main.hpp"

int main(int argc, char** argv) {
  using namespace houghstream;
  CLI::App app("Publishes RGB-D frames as images_t, or writes them to an LCM log", "hs-capture");
  std::string source;
  std::string log;
  std::string url;
  bool raw_colour = false;
  bool raw_depth = false;
  CaptureSettings settings;
  app.add_option("--source", source, "bop:DIR, uw:DIR, tum:DIR or render:NAME")->required();
  app.add_option("--log", log, "write this LCM log instead of publishing");
  app.add_option("--rate", settings.rate_hz, "frames per second; default: the source's");
  app.add_option("--frames", settings.frames, "end after this many frames")->check(CLI::PositiveNumber);
  app.add_flag("--loop", settings.loop, "start again at the end");
  app.add_flag("--raw-colour", raw_colour, "colour as raw RGB instead of JPEG");
  app.add_flag("--raw-depth", raw_depth, "depth as DEPTH_MM instead of DEPTH_MM_ZIPPED");
  app.add_option("--jpeg-quality", settings.format.jpeg_quality, "1 to 100")->capture_default_str();
  app.add_option("--zip-level", settings.format.zip_level, "1 to 9")->capture_default_str();
  app.add_option("-c,--channel", settings.channel, "channel of the frames")->capture_default_str();
  add_lcm_url_option(app, url);

  return run_tool(app, argc, argv, [&] {
    settings.format.jpeg = !raw_colour;
    settings.format.zip_depth = !raw_depth;
    require(log.empty() || !settings.loop || settings.frames, "--loop into a log never ends; give --frames");
    catch_stop_signals();
    const OpenSource open = [&] { return open_frame_source(source); };
    const CaptureResult result =
        log.empty() ? capture_to_network(open, settings, url) : capture_to_log(open, settings, log);
    spdlog::info(
        "{} frames of {:.1f} kB to {}, {:.1f} s, {:.1f} Hz", result.frames,
        static_cast<double>(result.bytes) / static_cast<double>(std::max<std::int64_t>(result.frames, 1)) / 1e3,
        log.empty() ? settings.channel : log, result.seconds,
        static_cast<double>(result.frames) / std::max(result.seconds, 1e-9));
  });
}
