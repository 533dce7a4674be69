#include <fmt/format.h>
#include <pcl/console/print.h>

#include <opencv2/core/utility.hpp>
#include <set>
#include <utility>

#include "detector/stages.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "pose/baseline/register_pcl.hpp"
#include "tools/common/tool_main.hpp"
#include "tools/evaluate/metrics/evaluated_frame.hpp"
#include "tools/finder/search_arguments.hpp"
#include "tools/finder/searched_objects.hpp"
#include "tools/finder/stored_forest.hpp"
#include "tools/finder/stored_quality.hpp"
#include "tools/studies/commands.hpp"
#include "tools/studies/pose/bench_report.hpp"

namespace {

using namespace houghstream;

struct BenchOptions {
  ObjectArguments known;
  std::vector<std::string> scenes;
  std::filesystem::path out;
  int every = 1;
  int baselines_every = 10;
  double baselines_s = 0.0;
  bool no_baselines = false;
  SearchOptions search;
  PoseSettings pose;  ///< settings of the store
};

BenchedMakers make_makers(const SceneModels& models, const BenchOptions& options) {
  BenchedMakers makers;
  const std::map<std::string, Mesh>& meshes = models.meshes;
  PoseSettings settings = options.pose;
  for (const auto& [name, model] : models.scored) settings.model.symmetries[name] = model.symmetries;
  makers.each_frame[kOurs] = estimator_maker(meshes, settings);
  settings.registration.engine = register_pcl;
  makers.each_frame[kPcl] = estimator_maker(meshes, settings);
  settings.registration.engine = options.pose.registration.engine;
  makers.each_frame[kUnchecked] = estimator_maker(meshes, without_rejection(settings));
  if (options.no_baselines) return makers;
  makers.baselines[kPrerejective] =
      baseline_maker(make_prerejective_baseline(meshes, options.pose, PrerejectiveSettings{}));
  makers.baselines[kPpf] = baseline_maker(make_ppf_baseline(meshes, options.pose, PpfSettings{}));
  return makers;
}

std::filesystem::path models_of(const BopScene& scene, const BenchOptions& options) {
  if (!options.known.models.empty()) return options.known.models;
  const std::optional<std::filesystem::path> found = find_bop_models(scene.folder());
  require(found.has_value(), "{}: no folder models/ in it or above, expected one or --models", scene.folder().string());
  return *found;
}

DetectedScene detect_scene(const std::string& name, const BopScene& scene, const Detector& detector, int every) {
  DetectedScene out{name, scene, every_nth(read_ground_truth(scene, find_bop_names(scene.folder())), every)};
  DetectorWorkspace workspace;
  for (EvaluatedFrame& frame : out.frames) frame.detections = detector.detect(scene.read_frame(frame.image), workspace);
  log_info("{}: {} frames", name, out.frames.size());
  return out;
}

void run(const BenchOptions& options) {
  // PCL prints a line for each start that finds no pairs; such a start is merely not converged.
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  // A thread's CPU time is all of a pose's only where OpenCV starts no threads of its own.
  cv::setNumThreads(1);
  const Detector detector = detector_of(load_named_forests(options.known, options.search.threads), options.search);
  std::set<std::string> classes;
  for (const Forest& forest : detector.groups()) {
    for (const ObjectClass& known : forest.classes) classes.insert(known.name);
  }
  PoseBench bench;
  std::map<std::string, BopScene> scenes;
  std::map<std::string, Mesh> meshes;
  std::filesystem::path models_folder;
  SceneModels models;
  BenchedMakers makers;
  for (const std::string& folder : options.scenes) {
    BopScene opened(folder);
    const auto [entry, is_new] = scenes.emplace(scene_name(opened), std::move(opened));
    require(is_new, "{}: a second scene of this name", folder);
    const auto& [name, scene] = *entry;
    if (const std::filesystem::path wanted = models_of(scene, options); wanted != models_folder) {
      models_folder = wanted;
      models = load_scene_models(wanted, classes);
      meshes.insert(models.meshes.begin(), models.meshes.end());
      makers = make_makers(models, options);
    }
    const DetectedScene detected = detect_scene(name, scene, detector, options.every);
    bench_scene(detected, models, makers, {options.baselines_every, options.baselines_s, options.search.threads},
                bench);
  }
  write_bench(bench, options.out);
  write_worst(bench.each_frame.at(kOurs).trials, scenes, meshes, options.out);
  fmt::print("{}", bench_summary(bench));
}

/// Returns the options with the store's forest, models, and quality settings of its objects, where one is named.
BenchOptions with_store(BenchOptions options) {
  require(options.known.store.empty() == !options.known.forest.empty(),
          "expected either --objects STORE or --forest FILE and --models FOLDER");
  options.pose = pose_settings_of(options.pose, resolve_store(options.known), std::nullopt);
  return options;
}

}  // namespace

int houghstream::studies::pose_command(CommandLine& app, int argc, char** argv) {
  BenchOptions options;
  options.search.threshold = PoseSettings{}.min_score;
  app.add_option("--objects", options.known.store, "object store of hs-teach, instead of --forest and --models");
  app.add_option("--forest", options.known.forest, "forest file");
  app.add_option("--scene", options.scenes, "BOP scene folder with the truth; may be given several times").required();
  app.add_option("--models", options.known.models, "models/ of a BOP dataset; default: that of each scene");
  app.add_option("--out", options.out, "folder for results.json, poses.csv and worst_N.png").required();
  app.add_option("--every", options.every, "look at every Nth frame only").range(1, 100000).capture_default_str();
  app.add_option("--rivals-every", options.baselines_every, "of those, the rivals look at every Mth; they are slow")
      .range(1, 100000)
      .capture_default_str();
  app.add_option("--rivals-seconds", options.baselines_s,
                 "the rivals look at as many frames of a scene as they can in this time; 0: no limit")
      .range(0.0, 1e6)
      .capture_default_str();
  app.add_flag("--no-rivals", options.no_baselines, "leave the rivals out");
  add_search_options(app, options.search);
  add_min_mass_option(app, options.search);
  app.get_option("--threshold").description("smallest score of a detection that is tried; default: 0.1");
  app.add_example("hs-study pose --forest my.forest --scene SCENE --out OUT");
  return run_tool(app, argc, argv, [&] { run(with_store(options)); });
}
