#include <set>

#include "drivers/datasets/bop_dataset.hpp"
#include "drivers/files/camera_info.hpp"
#include "drivers/store/store_stamp.hpp"
#include "drivers/store/store_watcher.hpp"
#include "pipeline/base/cache_folder.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/base/heap_memory.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/process/pose_process.hpp"
#include "pipeline/process/warm_up.hpp"
#include "pose/following/object_follower.hpp"
#include "pose/pose_estimator.hpp"
#include "pose/seen/camera_colours.hpp"
#include "tools/common/mesh_size.hpp"
#include "tools/common/tool_main.hpp"
#include "tools/common/usage_error.hpp"
#include "tools/finder/search_arguments.hpp"
#include "tools/finder/stored_precision.hpp"
#include "tools/finder/stored_quality.hpp"
#include "tools/pose/model_cache.hpp"

namespace {

using namespace houghstream;

/// Options of the command line.
struct PoseOptions {
  std::string objects;
  std::string cache;
  std::string models;
  double model_unit_m = 1e-3;
  std::string url;
  std::string output_log;
  bool replace = false;  // an output log that is there
  PoseSettings settings;
  std::optional<float> min_quality;
  std::optional<double> precision;  // chooses the qualities of a store's objects
  bool follow = false;
  PoseProcessOptions process;
};

/// Without a folder every detection has the status "no model".
std::map<std::string, Mesh> load_models(const PoseOptions& options, int threads) {
  if (!options.models.empty()) return load_class_models(options.models, options.model_unit_m, threads);
  log_warning("neither --objects nor --models: detections are answered without a pose");
  return {};
}

/// Estimates poses of one detection of each class in a synthetic frame, so that the models are in memory, and threads
/// run, before the first real one.
std::shared_ptr<const PoseEstimator> warmed_up(PoseEstimator cold, const RgbdFrame& made_up) {
  Detections detections;
  for (const auto& [name, model] : cold.models()) {
    Detection detection;
    detection.class_id = 1;
    detection.class_name = name;
    detection.score = 1.0F;
    detection.box_px = {240.0F, 160.0F, 160.0F, 160.0F};
    detection.centre_camera = {0.0F, 0.0F, 1.0F};
    detection.rotations.push_back({Eigen::Quaternionf::Identity(), 1.0F});
    detections.detections.push_back(std::move(detection));
  }
  auto estimator = std::make_shared<const PoseEstimator>(std::move(cold));
  estimator->estimate(made_up, detections);
  return estimator;
}

/// The estimator may be another one for each frame.
using CurrentEstimator = std::function<std::shared_ptr<const PoseEstimator>()>;

/// Logs once for each camera that its images have no colours.
void report_colourless(const RgbdFrame& frame, std::set<std::string>& reported) {
  if (reported.count(frame.id.channel) > 0 || !is_colourless(frame.colour)) return;
  reported.insert(frame.id.channel);
  log_warning("{}: pictures in black and white, expected colours: poses are judged without chroma", frame.id.channel);
}

void run(LcmBus& bus, PoseOptions options, const CurrentEstimator& current) {
  std::set<std::string> colourless;  // channels
  if (!options.follow) {
    std::map<std::string, CameraColours> cameras;  // colours by channel
    options.process.camera_colours = [&](const std::string& channel) { return cameras[channel].chroma(); };
    run_pose_process(bus, options.process,
                     [&](const RgbdFrame& frame, const Detections& detections, const ObjectPoses& earlier) {
                       report_colourless(frame, colourless);
                       CameraColours& colours = cameras[detections.frame.channel];
                       ObjectPoses poses = current()->estimate(frame, detections, earlier, colours.pairs());
                       colours.update(poses);
                       return poses;
                     });
    return;
  }
  ObjectFollower follower;
  options.process.camera_colours = [&](const std::string& channel) { return follower.camera_colours(channel); };
  options.process.camera_timing = [&](const std::string& channel) { return follower.camera_timing(channel); };
  run_follow_process(bus, options.process,
                     {[&](const RgbdFrame& frame) {
                        report_colourless(frame, colourless);
                        return follower.follow(*current(), frame);
                      },
                      [&](const RgbdFrame& frame, const Detections& detections) {
                        return follower.process_detections(*current(), frame, detections);
                      }});
}

/// Empty where there is no place for it.
std::filesystem::path folder_to_keep_in(const PoseOptions& options) {
  if (!options.cache.empty()) return options.cache;
  try {
    return cache_folder("--cache FOLDER") / "models";
  } catch (const InputError& error) {
    log_debug("models are not kept: {}", error.what());
    return {};
  }
}

/// Names the files that models are made of: a folder, and a stamp that changes with its files.
struct ModelFiles {
  std::filesystem::path folder;
  std::function<std::string()> stamp;
  std::function<std::map<std::string, Mesh>()> load;
};

/// Makes the estimator from the models cached at an earlier start, else from the meshes.
PoseEstimator estimator_of(const ModelFiles& files, const PoseSettings& settings, const ModelCache& kept, int threads) {
  const std::string state = kept.state_of(files.stamp(), settings.model);
  if (auto models = kept.find(files.folder, state)) return PoseEstimator::from_models(std::move(*models), settings);
  PoseEstimator made(files.load(), settings, threads);
  if (kept.state_of(files.stamp(), settings.model) == state) kept.keep(files.folder, state, made.models());
  return made;
}

/// Models stay what they are.
void run_with_models(PoseOptions options) {
  const ModelCache kept(folder_to_keep_in(options));
  const std::shared_future<RgbdFrame> made_up = start_warm_up();
  const int threads = warm_up_threads(options.settings.threads);
  std::map<std::string, Mesh> meshes = load_models(options, threads);
  const std::string fault = fault_of_sizes(meshes, options.model_unit_m, "--model-unit");
  if (!fault.empty()) log_warning("{}", fault);  // no frame will show such
  PoseSettings settings = pose_settings_of(options.settings, std::nullopt, options.min_quality);
  for (const auto& [name, mesh] : meshes) options.process.models.insert(name);
  if (!options.models.empty()) settings.model.symmetries = load_class_symmetries(options.models);
  const auto stamp = [&] { return fmt::format("{} m\n{}", options.model_unit_m, store::folder_stamp(options.models)); };
  const ModelFiles files{options.models, stamp, [&] { return std::move(meshes); }};
  auto estimator = warmed_up(estimator_of(files, settings, kept, threads), made_up.get());
  LcmBus bus(options.url, options.output_log, existing_of_recording(options.replace));
  run(bus, options, [&] { return estimator; });
}

/// Estimator and named frames of a store.
struct StoredEstimator {
  std::shared_ptr<const PoseEstimator> estimator;
  NamedFrames frames;
};

NamedFrames named_frames_of(const store::ObjectStore& store) {
  NamedFrames frames;
  for (const store::StoredObject& object : store.objects) {
    if (!object.frames.empty()) frames[object.name] = object.frames;
  }
  return frames;
}

/// A store may change while frames go by: each frame's poses are those of what is there when its turn comes.
void run_with_store(PoseOptions options) {
  const ModelCache kept(folder_to_keep_in(options));
  const std::shared_future<RgbdFrame> made_up = start_warm_up();
  const int threads = warm_up_threads(options.settings.threads);  // for the first store; later ones are loaded serially
  const auto load = [&](const store::ObjectStore& store) {
    PoseSettings settings = pose_settings_of(options.settings, store, options.min_quality);
    if (options.precision) set_precision(*options.precision, store, settings);
    const ModelFiles files{store.folder, [&] { return store::mesh_stamp(store); },
                           [&] { return store::load_store_meshes(store, threads); }};
    return std::make_shared<const StoredEstimator>(StoredEstimator{
        warmed_up(estimator_of(files, settings, kept, threads), made_up.get()), named_frames_of(store)});
  };
  store::StoreWatcher<StoredEstimator> watch(options.objects, load);
  const auto without_models = std::make_shared<const PoseEstimator>(std::map<std::string, Mesh>(), options.settings);
  options.process.objects = [&] { return watch.known(); };
  options.process.frames = [&] {
    const std::shared_ptr<const StoredEstimator> stored = watch.current();
    return stored ? stored->frames : NamedFrames();
  };
  LcmBus bus(options.url, options.output_log, existing_of_recording(options.replace));
  bus.is_log() ? watch.require_store() : watch.follow();
  run(bus, options, [&] {
    const std::shared_ptr<const StoredEstimator> stored = watch.current();
    return stored ? stored->estimator : without_models;
  });
}

}  // namespace

int main(int argc, char** argv) {
  CommandLine app("Refines detections to 6-DoF poses and publishes object_poses_t", "hs-pose");
  PoseOptions options;
  std::string camera;
  app.add_option("--objects", options.objects,
                 "object store of hs-teach, instead of --models; it may be made, and changed, while this runs");
  app.add_option("--cache", options.cache,
                 "where what is made of the meshes is kept for the next start; default ~/.cache/houghstream/models");
  add_model_options(app, options.models, options.model_unit_m);
  app.add_option("--camera", camera, kCameraOptionHelp);
  add_threads_option(app, options.settings.threads);
  app.add_option("--min-score", options.settings.min_score, "poses are looked for from this score of the detection on")
      .range(range_of(&PoseSettings::min_score))
      .capture_default_str();
  add_min_quality_option(app, options.min_quality)
      .description(
          fmt::format("poses that are right with a lower probability are withheld, and it is said why; default: {}, of "
                      "a store's objects {}, of candidates of these {}",
                      options.settings.quality.min_quality, kStoreQuality, kStoreCandidateQuality));
  add_precision_option(app, options.precision,
                       "with --objects: poses that are published shall be right, up to what the shape cannot tell, in "
                       "this fraction of the cases; each object has the least quality that its practice needed for it")
      .excludes(app.get_option("--min-quality"));
  app.add_flag(
      "--follow", options.follow,
      "follow known objects from frame to frame: poses for each frame, at once, whether detections come or not");
  add_frame_channels_option(app, options.process.frame_channels);
  app.add_option("--output-log", options.output_log, "with -l file://LOG: write the results to this log");
  app.add_flag(
      "--keep-frames", options.process.keep_frames,
      "with --output-log: write frames and detections too, each before its poses, for hs-track and hs-log export");
  add_replace_option(app, options.replace, "--output-log");
  add_lcm_url_option(app, options.url);
  app.add_example("hs-pose --objects my.store");
  app.add_example("hs-pose --models out/demo/data/training/models");

  return run_tool(app, argc, argv, [&] {
    share_one_heap();
    if (!camera.empty()) options.process.camera = camera_of_option(camera);
    require_usage(options.objects.empty() || options.models.empty(),
                  "expected either --objects STORE or --models FOLDER");
    require_usage(!options.precision || !options.objects.empty(),
                  "--precision goes with --objects, whose practice it reads");
    require_output_log(options.url, options.output_log);
    for (const std::string& input : {options.models, options.objects}) require_other_file(options.output_log, input);
    options.objects.empty() ? run_with_models(options) : run_with_store(options);
  });
}
