#include "drivers/files/camera_info.hpp"
#include "drivers/store/store_watcher.hpp"
#include "pipeline/base/cache_folder.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/base/stop_signal.hpp"
#include "pose/tracks/camera_extrinsics.hpp"
#include "tools/common/tool_main.hpp"
#include "tools/common/usage_error.hpp"
#include "tools/finder/track_models.hpp"
#include "tools/track/track_process.hpp"

namespace {

using namespace houghstream;

/// Options of the command line.
struct TrackOptions {
  std::string objects;
  std::string models;
  double model_unit_m = 1e-3;
  std::string url;
  std::string output_log;
  bool replace = false;  // an output log that is there
  std::string cameras_file;
  std::vector<std::string> camera_poses;
  bool drake_viewer = false;
  track::TrackProcessOptions process;
};

/// Logs the comparison of the cameras. Throws InputError where they contradict each other.
void report(const tracks::ExtrinsicCheck& check) {
  const std::vector<tracks::ExtrinsicInconsistency> pairs = check.pairs();
  require(!pairs.empty(), "no two cameras have seen the same objects at the same time often enough to compare them");
  for (const tracks::ExtrinsicInconsistency& pair : pairs) {
    const Eigen::Vector3d mm = 1000.0 * pair.offset_m;
    fmt::print("{} and {}: objects {:.1f} mm apart ({:+.1f}, {:+.1f}, {:+.1f} along the world's axes), {} compared\n",
               pair.first, pair.second, mm.norm(), mm.x(), mm.y(), mm.z(), pair.samples);
  }
  const std::vector<tracks::ExtrinsicInconsistency> wrong = check.inconsistencies();
  if (wrong.empty()) return;
  fail("{} and {} see the same objects {:.1f} cm apart, expected at most {:.1f} cm: one of their places is wrong",
       wrong.front().first, wrong.front().second, 100.0 * wrong.front().offset_m.norm(),
       100.0 * tracks::ExtrinsicCheck::kReport_m);
}

void run(LcmBus& bus, const TrackOptions& options, const track::CurrentModels& models) {
  const tracks::ExtrinsicCheck check = track::run_track_process(bus, options.process, models);
  if (options.process.check) report(check);
}

void run_with_models(const TrackOptions& options) {
  auto models = std::make_shared<const tracks::TrackModels>(
      options.models.empty() ? tracks::TrackModels() : load_track_models(options.models, options.model_unit_m));
  if (models->empty()) log_warning("neither --objects nor --models: what is hidden or gone cannot be told");
  LcmBus bus(options.url, options.output_log, existing_of_recording(options.replace));
  run(bus, options, [&] { return models; });
}

/// A store may change while frames go by.
void run_with_store(TrackOptions options) {
  store::StoreWatcher<tracks::TrackModels> watch(options.objects, [](const store::ObjectStore& store) {
    return std::make_shared<const tracks::TrackModels>(stored_track_models(store));
  });
  const auto none = std::make_shared<const tracks::TrackModels>();
  options.process.objects = [&] { return watch.known(); };
  LcmBus bus(options.url, options.output_log, existing_of_recording(options.replace));
  bus.is_log() ? watch.require_store() : watch.follow();
  run(bus, options, [&] {
    std::shared_ptr<const tracks::TrackModels> models = watch.current();
    return models ? models : none;
  });
}

void add_options(CommandLine& app, TrackOptions& options, std::string& camera) {
  app.add_option("--objects", options.objects,
                 "object store of hs-teach, instead of --models; it may be made, and changed, while this runs");
  add_model_options(app, options.models, options.model_unit_m);
  app.add_option("--camera", camera, kCameraOptionHelp);
  app.add_option("--cameras", options.cameras_file,
                 "YAML file of where cameras stand: cameras: {CHANNEL: {translation: [x, y, z], rotation: [w, x, y, "
                 "z]}}, or static transforms as ROS prints them");
  app.add_option("--camera-pose", options.camera_poses,
                 "CHANNEL=x,y,z,qw,qx,qy,qz: where one camera stands, T_world_camera, metres; may be given several "
                 "times");
  app.add_option("--wait", options.process.wait_s,
                 "seconds that a frame waits for the transforms of its camera (<CAMERA>_TO_WORLD) about its time")
      .range(0.0, 10.0)
      .capture_default_str();
  app.add_flag("--check", options.process.check,
               "publish nothing; compare where the cameras see the same objects, and fail where they contradict each "
               "other");
  app.add_flag("--drake-viewer", options.drake_viewer,
               "show the objects' meshes in drake_visualizer and meldis too (DRAKE_VIEWER_LOAD_ROBOT, _DRAW)");
  app.add_flag("--pose-channels", options.process.output.pose_channels,
               "publish each object's pose on <OBJECT>_<NUMBER>_POSE too, as bot_core's pose_t");
  add_frame_channels_option(app, options.process.frame_channels);
  app.add_option("--output-log", options.output_log, "with -l file://LOG: write the objects to this log");
  add_replace_option(app, options.replace, "--output-log");
  add_lcm_url_option(app, options.url);
}

}  // namespace

int main(int argc, char** argv) {
  CommandLine app("Follows objects over frames and cameras, in one world, and publishes objects_t", "hs-track");
  TrackOptions options;
  std::string camera;
  add_options(app, options, camera);
  app.add_example("hs-track --objects my.store -c 'CAMERA_[12]' --cameras cameras.yaml");
  return run_tool(app, argc, argv, [&] {
    catch_stop_signals();
    if (!camera.empty()) options.process.camera = camera_of_option(camera);
    require_usage(options.objects.empty() || options.models.empty(),
                  "expected either --objects STORE or --models FOLDER");
    require(!options.process.check || options.output_log.empty(),
            "--output-log {}: --check publishes nothing, expected one of the two", options.output_log);
    if (!options.process.check) require_output_log(options.url, options.output_log);
    for (const std::string& input : {options.models, options.objects, options.cameras_file})
      require_other_file(options.output_log, input);
    if (options.drake_viewer)
      options.process.output.drake_meshes = cache_folder("one of them for the meshes of --drake-viewer") / "meshes";
    if (!options.cameras_file.empty())
      options.process.camera_poses = tracks::read_camera_extrinsics(options.cameras_file);
    for (const std::string& text : options.camera_poses) tracks::add_camera_pose(text, options.process.camera_poses);
    options.objects.empty() ? run_with_models(options) : run_with_store(options);
  });
}
