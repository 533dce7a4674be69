#include "detector/detector.hpp"
#include "detector/forest/forest_file.hpp"
#include "detector/stages.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/base/stop_signal.hpp"
#include "pipeline/process/detect_process.hpp"
#include "tools/common/search_options.hpp"
#include "tools/common/tool_main.hpp"

int main(int argc, char** argv) {
  using namespace houghstream;
  CommandLine app(
      "Finds the taught objects in the newest RGB-D frame of each camera in turn and publishes detections_t",
      "hs-detect");
  std::string forest_file;
  std::string camera;
  std::string url;
  std::string output_log;
  SearchOptions search;
  DetectProcessOptions options;
  app.add_option("--forest", forest_file, "forest file of hs-train").required();
  app.add_option("--camera", camera, "WIDTHxHEIGHT,fx,fy,cx,cy for frames without a camera of their own");
  add_search_options(app, search);
  add_frame_channels_option(app, options.frame_channels);
  app.add_option("--output-log", output_log, "with -l file://LOG: write the results to this log");
  app.add_flag("--keep-frames", options.keep_frames,
               "with --output-log: write the frames too, each before its result, so that hs-pose can work on that log");
  add_lcm_url_option(app, url);

  return run_tool(app, argc, argv, [&] {
    catch_stop_signals();
    if (!camera.empty()) options.camera = parse_camera(camera);
    Forest forest = load_forest(forest_file);
    const DetectionSettings settings = search.settings_for(forest);
    const Detector detector(std::move(forest), settings);
    for (const ObjectClass& object : detector.forest().classes) {
      log_debug("class {}: {}", object.class_id, object.name);
    }
    LcmBus bus(url, output_log);
    DetectorWorkspace workspace;
    run_detect_process(bus, options, [&](const RgbdFrame& frame) { return detector.detect(frame, workspace); });
  });
}
