#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>

#include "tools/view/viewer.hpp"

namespace {

void add_options(CLI::App& app, houghstream::ViewerSettings& settings, bool& verbose) {
  houghstream::OutputSettings& outputs = settings.outputs;
  app.add_option("-l,--lcm-url", settings.lcm_url, "LCM URL (default: $LCM_DEFAULT_URL, else udpm with ttl=0)");
  app.add_option("-c,--channel", settings.frame_channel, "channel of the frames")->capture_default_str();
  app.add_option("--models", settings.models, "BOP models folder: draws the outlines of the models");
  app.add_option("--snapshot", outputs.snapshot, "write one picture to this file (.png or .jpg)");
  app.add_option("--after", outputs.snapshot_after, "the snapshot is the so-manieth picture drawn")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_option("--video", outputs.video, "write a video to this file (.mp4)");
  app.add_option("--pictures", outputs.pictures, "write every picture drawn to this folder");
  app.add_option("--rate", outputs.rate_hz, "pictures drawn per second, at most")
      ->capture_default_str()
      ->check(CLI::Range(0.1, 100.0));
  app.add_option("--duration", settings.duration, "end after so many seconds (0: when stopped)")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  app.add_flag_callback(
      "--no-depth", [&] { settings.picture.show_depth = false; }, "show the colour image only");
  app.add_flag("-v,--verbose", verbose, "say more");
  app.set_version_flag("--version", std::string("hs-view " HOUGHSTREAM_VERSION));
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Shows the stream: boxes, names, scores, pose axes and model outlines over each frame, depth, stage times and "
      "latency. With --snapshot, --video or --pictures it needs no display.");
  houghstream::ViewerSettings settings;
  bool verbose = false;
  add_options(app, settings, verbose);
  CLI11_PARSE(app, argc, argv);
  spdlog::set_default_logger(spdlog::stderr_color_mt("hs-view"));
  if (verbose) spdlog::set_level(spdlog::level::debug);
  try {
    houghstream::run_viewer(settings);
  } catch (const std::exception& error) {
    spdlog::error("{}", error.what());
    return 1;
  }
  return 0;
}
