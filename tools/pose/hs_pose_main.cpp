#include "drivers/datasets/bop_dataset.hpp"
#include "drivers/store/object_store.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/base/stop_signal.hpp"
#include "pipeline/process/pose_process.hpp"
#include "pose/pose_estimator.hpp"
#include "tools/common/stored_quality.hpp"
#include "tools/common/tool_main.hpp"

namespace {

/// Meshes by class name; without a folder every detection is answered with "no model".
std::map<std::string, houghstream::Mesh> load_models(const std::string& objects, const std::string& folder,
                                                     double unit_m) {
  using namespace houghstream;
  require(objects.empty() || folder.empty(), "expected either --objects STORE or --models FOLDER");
  if (!objects.empty()) return store::load_store_meshes(store::read_store(objects));
  if (!folder.empty()) return load_class_models(folder, unit_m);
  log_warning("neither --objects nor --models: detections are answered without a pose");
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  using namespace houghstream;
  CommandLine app("Refines detections to 6-DoF poses and publishes object_poses_t", "hs-pose");
  std::string objects;
  std::string models;
  double model_unit_m = 1e-3;
  std::string camera;
  std::string url;
  std::string output_log;
  PoseSettings settings;
  std::optional<float> min_quality;
  PoseProcessOptions options;
  app.add_option("--objects", objects, "object store of hs-teach, instead of --models");
  add_model_options(app, models, model_unit_m);
  app.add_option("--camera", camera, "WIDTHxHEIGHT,fx,fy,cx,cy for frames without a camera of their own");
  app.add_option("--threads", settings.threads, "threads").range(1, 64).capture_default_str();
  app.add_option("--min-score", settings.min_score, "poses are looked for from this score of the detection on")
      .range(0.0, 1.0)
      .capture_default_str();
  app.add_option("--min-quality", min_quality,
                 fmt::format("poses that are right with a lower probability are withheld, and it is said why; default: "
                             "{}, of a store's objects {}",
                             settings.quality.least, kStoreQuality))
      .range(0.0, 1.0);
  add_frame_channels_option(app, options.frame_channels);
  app.add_option("--output-log", output_log, "with -l file://LOG: write the results to this log");
  add_lcm_url_option(app, url);

  return run_tool(app, argc, argv, [&] {
    catch_stop_signals();
    if (!camera.empty()) options.camera = parse_camera(camera);
    std::map<std::string, Mesh> meshes = load_models(objects, models, model_unit_m);
    settings.quality.least = min_quality.value_or(objects.empty() ? settings.quality.least : kStoreQuality);
    if (!objects.empty()) settings.class_quality = stored_quality(store::read_store(objects), settings.quality);
    for (const auto& [name, mesh] : meshes) options.models.insert(name);
    const PoseEstimator estimator(std::move(meshes), settings);
    LcmBus bus(url, output_log);
    run_pose_process(bus, options,
                     [&](const RgbdFrame& frame, const Detections& detections, const ObjectPoses& earlier) {
                       return estimator.estimate(frame, detections, earlier);
                     });
  });
}
