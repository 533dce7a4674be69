#include "tools/evaluate/evaluate_main.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "detector/detector.hpp"
#include "detector/forest/forest_file.hpp"
#include "pipeline/base/checks.hpp"
#include "tools/common/search_options.hpp"
#include "tools/common/tool_main.hpp"
#include "tools/evaluate/bop_results.hpp"
#include "tools/evaluate/class_names.hpp"
#include "tools/evaluate/frame_times.hpp"
#include "tools/evaluate/in_process.hpp"
#include "tools/evaluate/report.hpp"

namespace houghstream {
namespace {

struct EvaluateOptions {
  std::string scene;
  std::string log;
  std::string channel = ".*";
  std::string forest;
  std::string models;
  std::string latency;
  std::string out;
  std::vector<std::string> classes;
  EvaluationRules rules;
  SearchOptions search;
  int every = 1;
};

/// Whose names are measured: those that were asked for, else the forest's, else the truth's.
NamedSide listed_side(const EvaluateOptions& options, const std::optional<Forest>& forest, const NamedSide& truth) {
  if (!options.classes.empty()) return {"--classes", {options.classes.begin(), options.classes.end()}};
  if (!forest) return truth;
  NamedSide side{"the forest " + options.forest, {}};
  for (const ObjectClass& known : forest->classes) side.names.insert(known.name);
  return side;
}

/// The classes to measure, in the order in which they were asked for, else by name. Throws InputError where they are no
/// class of the truth or of the models; a scene without objects is there to count false detections.
std::vector<std::string> listed_classes(const EvaluateOptions& options, const std::optional<Forest>& forest,
                                        const NamedSide& truth, const std::map<std::string, Mesh>& meshes) {
  const NamedSide listed = listed_side(options, forest, truth);
  if (!truth.names.empty()) require_shared_name(listed, truth);
  if (!meshes.empty() && !listed.names.empty()) {
    NamedSide models{"the models " + options.models, {}};
    for (const auto& [name, mesh] : meshes) models.names.insert(name);
    require_shared_name(listed, models);
  }
  if (!options.classes.empty()) return options.classes;
  return {listed.names.begin(), listed.names.end()};
}

/// Poses are measured for the listed classes that have a model.
Evaluation measure(const EvaluateOptions& options, const BopScene& scene, const std::vector<EvaluatedFrame>& frames,
                   const std::vector<std::string>& classes, const std::map<std::string, Mesh>& meshes) {
  if (meshes.empty()) return evaluate(frames, classes, {}, options.rules);
  std::map<std::string, PoseModel> models;
  std::map<std::string, BopModel> listed;
  for (auto& [name, model] : make_bop_models(meshes, read_bop_models(options.models))) {
    models[name] = make_pose_model(model.mesh, model.symmetries.size() > 1);
    if (std::find(classes.begin(), classes.end(), name) != classes.end()) listed[name] = model;
  }
  Evaluation evaluation = evaluate(frames, classes, models, options.rules);
  if (evaluation.frames_with_poses > 0) {
    const std::vector<EvaluatedFrame> counted = counted_frames(frames, options.rules);
    evaluation.localisation = localisation_scores(measure_poses(counted, scene, listed, options.search.threads));
  }
  return evaluation;
}

PublishedResults search_in_process(const EvaluateOptions& options, const BopScene& scene, const Forest& forest,
                                   const std::map<std::string, Mesh>& models) {
  const Detector detector(forest, options.search.settings_for(forest), options.search.engine());
  return run_in_process(scene, detector, options.every, models);
}

/// Published results, or those of the forest in this process.
PublishedResults read_results(const EvaluateOptions& options, const BopScene& scene,
                              const std::optional<Forest>& forest, const std::map<std::string, Mesh>& meshes) {
  if (!options.log.empty()) return read_result_log(options.log, options.channel);
  return search_in_process(options, scene, *forest, meshes);
}

void run(const EvaluateOptions& options) {
  require(!options.log.empty() || !options.forest.empty(), "neither --log nor --forest, expected results to evaluate");
  const BopScene scene(options.scene);
  const std::map<int, std::string> names = find_bop_names(options.scene);
  std::vector<EvaluatedFrame> frames = read_truth(scene, names);
  std::optional<Forest> forest;
  if (!options.forest.empty()) forest = load_forest(options.forest);
  const std::map<std::string, Mesh> meshes =
      options.models.empty() ? std::map<std::string, Mesh>() : load_class_models(options.models);
  const NamedSide truth{"the scene " + options.scene, true_names(frames)};
  const std::vector<std::string> classes = listed_classes(options, forest, truth, meshes);
  const PublishedResults results = read_results(options, scene, forest, meshes);
  const std::string source = options.log.empty() ? options.scene : options.log;
  const std::set<std::string> detected = detected_names(results.detections);
  if (!forest && !detected.empty() && !truth.names.empty()) require_shared_name({"the log " + source, detected}, truth);
  frames = every_nth(std::move(frames), options.every);
  add_results(frames, results, source);
  const Evaluation evaluation = measure(options, scene, frames, classes, meshes);
  std::optional<Latencies> latencies;
  if (!options.latency.empty()) latencies = read_latencies(options.latency);
  fmt::print("{}", summary_table(evaluation, options.rules));
  if (options.out.empty()) return;
  write_report(evaluation, summary_json(evaluation, options.rules, latencies), options.out);
  write_frame_times(frames, scene, std::filesystem::path(options.out) / kFrameTimesFile);
  if (!results.poses.empty())
    write_bop_results(bop_estimates(frames, scene, names), std::filesystem::path(options.out) / kBopResultsFile);
}

void add_options(CommandLine& app, EvaluateOptions& options) {
  app.add_option("--scene", options.scene, "BOP scene folder with the truth; without objects, every detection is false")
      .required();
  app.add_option("--log", options.log, "LCM log with published results");
  add_frame_channels_option(app, options.channel)
      .description(
          "with --log: results of frames on these channels, a regular expression for the whole name; one camera's");
  app.add_option("--forest", options.forest, "forest: detects in-process without --log, and names the classes");
  app.add_option("--models", options.models, "models/ of the scene: measures poses (in-process: estimates them)");
  app.add_option("--classes", options.classes, "classes to measure; default: the forest's, else the truth's")
      .delimiter(',');
  app.add_option("--latency", options.latency, "hs-observe's CSV");
  app.add_option(
      "--out", options.out,
      "folder for summary.json, curves.csv, poses.csv, frames.csv, and bop_results.csv where there are poses");
  EvaluationRules& rules = options.rules;
  rules.operating_score = EvidenceSettings{}.threshold;  // what hs-detect publishes unless told otherwise
  app.add_option("--min-iou", rules.detection.min_iou, "overlap of a true detection").capture_default_str();
  app.add_option("--min-visible", rules.detection.min_visible, "less visible objects are ignored")
      .capture_default_str();
  app.add_option("--pose-min-visible", rules.pose_min_visible, "less visible objects do not enter the pose recall")
      .capture_default_str();
  app.add_option("--operating-score", rules.operating_score, "score from which precision and false detections count")
      .capture_default_str();
  app.add_flag("--processed-only", rules.processed_only, "leave skipped frames out; default: they count as missed");
  app.add_option("--every", options.every, "look at every Nth frame only").range(1, 100000).capture_default_str();
  add_search_options(app, options.search);
  app.add_option("--min-mass", options.search.min_mass_share,
                 "in-process: vote mass, over a whole object's, from which a maximum counts; default: the profile's");
}

}  // namespace

int evaluate_main(int argc, char** argv, const std::string& name) {
  CommandLine app("Compares detections and poses with the truth of a scene", name);
  EvaluateOptions options;
  add_options(app, options);
  return run_tool(app, argc, argv, [&] { run(options); });
}

}  // namespace houghstream
