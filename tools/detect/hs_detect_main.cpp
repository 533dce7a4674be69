#include "detector/detector.hpp"
#include "detector/forest/forest_file.hpp"
#include "detector/stages.hpp"
#include "drivers/store/object_store.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/base/stop_signal.hpp"
#include "pipeline/process/detect_process.hpp"
#include "tools/common/search_options.hpp"
#include "tools/common/tool_main.hpp"

namespace {

using namespace houghstream;

/// The forest of a file, or of an object store.
Forest load_taught(const std::string& forest_file, const std::string& objects) {
  require(forest_file.empty() != objects.empty(), "expected either --objects STORE or --forest FILE");
  if (objects.empty()) return load_forest(forest_file);
  const store::ObjectStore store = store::read_store(objects);
  Forest forest = load_forest(store.forest_file());
  std::vector<std::string> names;
  for (const ObjectClass& object : forest.classes) names.push_back(object.name);
  store::require_same_objects(store, names);
  return forest;
}

}  // namespace

int main(int argc, char** argv) {
  CommandLine app(
      "Finds the taught objects in the newest RGB-D frame of each camera in turn and publishes detections_t",
      "hs-detect");
  std::string forest_file;
  std::string objects;
  std::string camera;
  std::string url;
  std::string output_log;
  SearchOptions search;
  DetectProcessOptions options;
  app.add_option("--objects", objects, "object store of hs-teach");
  app.add_option("--forest", forest_file, "forest file of hs-train, instead of --objects");
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
    Forest forest = load_taught(forest_file, objects);
    if (!objects.empty() && !search.threshold) search.threshold = kStoreThreshold;
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
