#include <fmt/ranges.h>

#include "drivers/files/camera_info.hpp"
#include "pipeline/base/checks.hpp"
#include "tools/common/tool_main.hpp"
#include "tools/view/viewer.hpp"

namespace {

void add_options(houghstream::CommandLine& app, houghstream::view::ViewerSettings& settings, std::string& camera) {
  houghstream::view::FrameRendererSettings& show = settings.show;
  houghstream::view::OutputSettings& outputs = show.outputs;
  houghstream::add_frame_channels_option(app, settings.frame_channels);
  app.add_option("--camera", camera, houghstream::kCameraOptionHelp);
  app.add_option("--objects", show.objects,
                 "object store of hs-teach with the models; it may be made, and changed, while this runs");
  houghstream::add_model_options(app, show.models, show.model_unit_m);
  app.add_option("--snapshot", outputs.snapshot, "write one picture to this file (.png or .jpg)");
  app.add_option("--after", outputs.snapshot_after, "the snapshot is the Nth picture drawn")
      .capture_default_str()
      .positive();
  app.add_option("--video", outputs.video, "write a video to this file (.mp4)");
  app.add_option("--pictures", outputs.images, "write every picture drawn to this folder");
  houghstream::add_replace_option(app, outputs.replace, "--snapshot, --video or --pictures");
  app.add_flag("--preview", show.preview, "send JPEGs below 100 kB on HOUGHSTREAM_PREVIEW");
  app.add_option("--http", show.http,
                 "serve a page for browsers at [ADDRESS:]PORT; without an address for this machine only");
  app.add_option("--foxglove", show.foxglove, "serve the stream to Foxglove, as --http");
  app.add_option("--http-host", show.http_hosts, "further name for --http, --foxglove; repeatable");
  app.add_option("--rate", outputs.rate_hz, "pictures drawn per second, at most")
      .capture_default_str()
      .range(0.1, 100.0);
  app.add_option("--duration", settings.duration, "end after so many seconds (0: when stopped)")
      .capture_default_str()
      .non_negative();
  app.add_option("--min-score", show.image.min_score,
                 "weaker detections are not drawn; default 0: everything that is reported, which has a threshold "
                 "of its own")
      .range(0.0, 1.0);
  app.add_clearing_flag("--no-depth", show.image.show_depth, "show the colour image only");
  app.add_flag("--3d", show.image.show_3d, "instead of the depth image: what was measured, seen from elsewhere");
  app.add_flag("--world", show.image.show_world,
               "instead of the depth image: the world of hs-track from above, with all cameras");
  houghstream::add_lcm_url_option(app, settings.lcm_url);
}

}  // namespace

int main(int argc, char** argv) {
  houghstream::CommandLine app(
      "Shows the stream: boxes, names, scores, pose axes and model outlines over each frame, depth, stage times and "
      "latency. Of several cameras one is shown at a time: the first that is heard, the next one after key c. With "
      "--snapshot, --video, --pictures, --preview, --http or --foxglove it needs no display.",
      "hs-view");
  houghstream::view::ViewerSettings settings;
  std::string camera;
  add_options(app, settings, camera);
  app.add_example("hs-view --objects my.store");
  app.add_example("hs-view --models out/demo/data/training/models --snapshot seen.png --after 30");
  return houghstream::run_tool(app, argc, argv, [&] {
    houghstream::require(
        settings.show.http_hosts.empty() || !settings.show.http.empty() || !settings.show.foxglove.empty(),
        "--http-host {}: no page is served, expected --http or --foxglove too",
        fmt::join(settings.show.http_hosts, ", "));
    if (!camera.empty()) settings.show.camera = houghstream::camera_of_option(camera);
    houghstream::view::run_viewer(settings);
  });
}
