#include "tools/evaluate/evaluate_main.hpp"

#include <fmt/ranges.h>

#include <set>

#include "detector/detector.hpp"
#include "detector/forest/forest_file.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "tools/common/tool_main.hpp"
#include "tools/common/usage_error.hpp"
#include "tools/evaluate/bop_results.hpp"
#include "tools/evaluate/bop_targets.hpp"
#include "tools/evaluate/class_names.hpp"
#include "tools/evaluate/metrics/search_times.hpp"
#include "tools/evaluate/report.hpp"
#include "tools/evaluate/scene_figures.hpp"
#include "tools/finder/search_arguments.hpp"
#include "tools/finder/searched_objects.hpp"
#include "tools/finder/stored_forest.hpp"
#include "tools/finder/stored_precision.hpp"
#include "tools/finder/stored_quality.hpp"

namespace houghstream {
namespace {

struct EvaluateOptions {
  std::vector<std::string> scenes;
  std::string targets;
  std::string log;
  std::string channel = ".*";
  ObjectArguments known;
  std::optional<float> operating_score;
  PoseSettings pose;  // settings by which poses are published
  std::string latency;
  std::string out;
  std::vector<std::string> classes;
  EvaluationRules rules;
  SearchOptions search;
  EvaluateSearch in_process;
  std::optional<float> min_quality;
  int every = 1;
  double rate_hz = kDatasetRateHz;
};

std::vector<OpenScene> open_scenes(const EvaluateOptions& options) {
  std::vector<OpenScene> scenes;
  std::set<std::string> folder_names;
  for (const std::string& folder : options.scenes) {
    const BopScene scene(folder);
    require(folder_names.insert(scene_name(scene)).second, "--scene {}: two scenes of this folder name, expected one",
            folder);
    std::map<int, std::string> names = find_bop_names(folder);
    std::vector<EvaluatedFrame> frames = read_ground_truth(scene, names);
    stamp_at_rate(options.rate_hz, frames);
    scenes.push_back({scene, std::move(names), std::move(frames)});
  }
  return scenes;
}

/// Keeps the frames that the options select.
void choose_frames(const EvaluateOptions& options, std::vector<OpenScene>& scenes) {
  std::vector<BopTarget> targets;
  if (!options.targets.empty()) targets = read_bop_targets(options.targets);
  for (OpenScene& it : scenes) {
    if (!targets.empty()) it.frames = targeted_frames(std::move(it.frames), targets, options.targets);
    it.frames = every_nth(std::move(it.frames), options.every);
  }
}

NamedSide ground_truth_side(const EvaluateOptions& options, const std::vector<OpenScene>& scenes) {
  NamedSide side{fmt::format("the scene{} {}", scenes.size() > 1 ? "s" : "", fmt::join(options.scenes, ", ")), {}};
  for (const OpenScene& it : scenes) side.names.merge(ground_truth_names(it.frames));
  return side;
}

/// Returns the side whose names are measured: those that were asked for, else the forest's, else the truth's.
NamedSide listed_side(const EvaluateOptions& options, const std::vector<Forest>& groups, const NamedSide& truth) {
  if (!options.classes.empty()) return {"--classes", {options.classes.begin(), options.classes.end()}};
  if (groups.empty()) return truth;
  NamedSide side{"the forest " + options.known.forest, {}};
  for (const Forest& forest : groups) {
    for (const ObjectClass& known : forest.classes) side.names.insert(known.name);
  }
  return side;
}

/// Returns the classes to measure, in the order in which they were asked for, else by name. Throws InputError where
/// they are no class of the truth or of the models; a scene without objects is there to count false detections.
std::vector<std::string> listed_classes(const EvaluateOptions& options, const std::vector<Forest>& groups,
                                        const NamedSide& truth, const std::map<std::string, Mesh>& meshes) {
  const NamedSide listed = listed_side(options, groups, truth);
  if (!truth.names.empty()) require_shared_name(listed, truth);
  if (!meshes.empty() && !listed.names.empty()) {
    NamedSide models{"the models " + options.known.models, {}};
    for (const auto& [name, mesh] : meshes) models.names.insert(name);
    require_shared_name(listed, models);
  }
  if (!options.classes.empty()) return options.classes;
  return {listed.names.begin(), listed.names.end()};
}

/// Returns from which score on detections are listed.
float search_in_process(const EvaluateOptions& options, std::vector<Forest> groups,
                        const std::map<std::string, Mesh>& meshes, std::vector<OpenScene>& scenes) {
  PublishingRules rules;
  rules.score = options.rules.operating_score;
  rules.class_scores = options.rules.class_operating_scores;
  if (!options.operating_score) rules.candidates_from = kCandidatesFrom;
  rules.pose = options.pose;
  if (!options.known.models.empty()) rules.pose.model.symmetries = load_class_symmetries(options.known.models);
  const DetectionSettings settings = options.search.change(options.in_process.settings(groups.front()));
  InProcess process(std::move(groups), settings, options.in_process.make, meshes, rules);
  for (OpenScene& it : scenes) process.run(it.scene, it.frames);
  return process.ranked_from();
}

void add_log(const EvaluateOptions& options, bool check_names, const NamedSide& truth, OpenScene& it) {
  const PublishedResults results = read_result_log(options.log, options.channel);
  const std::set<std::string> detected = detected_names(results.detections);
  if (check_names && !detected.empty() && !truth.names.empty())
    require_shared_name({"the log " + options.log, detected}, truth);
  add_results(it.frames, results, options.log);
}

void write_files(const EvaluateOptions& options, const SceneFigures& figures, const std::vector<OpenScene>& scenes,
                 const std::optional<Latencies>& latencies) {
  write_report(figures.all,
               scenes.size() > 1 ? summary_json(figures.all, figures.scenes, options.rules, latencies)
                                 : summary_json(figures.all, options.rules, latencies),
               options.out);
  std::vector<EvaluatedFrame> frames;
  for (const OpenScene& it : scenes) frames.insert(frames.end(), it.frames.begin(), it.frames.end());
  write_search_times(frames, std::filesystem::path(options.out) / kSearchTimesFile);
  if (figures.all.frames_with_poses == 0) return;
  std::vector<BopEstimate> estimates;
  for (const OpenScene& it : scenes) {
    const std::vector<BopEstimate> here = bop_estimates(it.frames, it.names);
    estimates.insert(estimates.end(), here.begin(), here.end());
  }
  write_bop_results(estimates, std::filesystem::path(options.out) / kBopResultsFile);
}

/// Checks before any search that the report has a place, which is not among its inputs.
void check_place(const EvaluateOptions& options) {
  if (options.out.empty()) return;
  require_writable_folder(options.out);
  for (const std::string& scene : options.scenes) require_other_file(options.out, scene);
  for (const std::string& input : {options.known.models, options.known.store}) require_other_file(options.out, input);
}

void run(EvaluateOptions options) {
  check_place(options);
  require_usage(!options.log.empty() || !options.known.forest.empty(),
                "neither --log nor --forest nor --objects, expected results to evaluate");
  require_usage(options.log.empty() || options.scenes.size() == 1,
                "--log with {} scenes, expected the one that it is of", options.scenes.size());
  std::optional<Latencies> latencies;
  if (!options.latency.empty()) latencies = read_latencies(options.latency);
  std::vector<OpenScene> scenes = open_scenes(options);
  std::vector<Forest> groups;
  if (!options.known.forest.empty()) groups = load_named_forests(options.known, options.search.threads);
  const std::map<std::string, Mesh> meshes =
      options.known.models.empty() ? std::map<std::string, Mesh>() : load_class_models(options.known.models);
  const NamedSide truth = ground_truth_side(options, scenes);
  const std::vector<std::string> classes = listed_classes(options, groups, truth, meshes);
  if (!options.log.empty()) add_log(options, groups.empty(), truth, scenes.front());
  choose_frames(options, scenes);
  if (options.log.empty()) {
    if (!options.rules.precision) options.rules.min_quality = options.pose.quality.min_quality;
    options.rules.ranked_from = search_in_process(options, std::move(groups), meshes, scenes);
  }
  const SceneFigures figures =
      measure_scenes(scenes, classes, make_scored_models(options.known.models, meshes, classes), options.rules,
                     options.search.threads);
  fmt::print("{}", summary_table(figures.all, options.rules));
  if (!options.out.empty()) write_files(options, figures, scenes, latencies);
}

void add_options(CommandLine& app, EvaluateOptions& options) {
  app.add_option("--scene", options.scenes,
                 "BOP scene folder with the truth; without objects every detection is false; several, of one camera: "
                 "together and each by itself")
      .required();
  app.add_option("--targets", options.targets,
                 "BOP's list of targets (test_targets_bop19.json): only its images and objects are asked for");
  app.add_option("--log", options.log, "LCM log with published results");
  app.add_option("--rate", options.rate_hz, "with --log: hs-capture's --rate, by which it stamped the scene's frames")
      .range(1e-3, 1000.0);
  add_frame_channels_option(app, options.channel)
      .description(
          "with --log: results of frames on these channels, a regular expression for the whole name; one camera's");
  app.add_option("--forest", options.known.forest, "searched where no --log is given; names the classes");
  app.add_option("--objects", options.known.store, "store of hs-teach, for --forest and --models");
  app.add_option("--models", options.known.models, "models/ of the scene: poses are measured too");
  app.add_option("--classes", options.classes, "measured; default: the forest's, else the truth's").delimiter(',');
  app.add_option("--latency", options.latency, "hs-observe's CSV");
  app.add_option(
      "--out", options.out,
      "folder for summary.json, curves.csv, frames.csv, poses.csv, reliability.png, and bop_results.csv where "
      "there are poses");
  EvaluationRules& rules = options.rules;
  app.add_option("--min-iou", rules.detection.min_iou, "overlap of a true detection")
      .range(0.0, 1.0)
      .capture_default_str();
  app.add_option("--min-visible", rules.detection.min_visible, "less visible objects are ignored")
      .range(0.0, 1.0)
      .capture_default_str();
  app.add_option("--pose-min-visible", rules.pose_min_visible, "less visible objects do not enter the pose recall")
      .range(0.0, 1.0)
      .capture_default_str();
  app.add_option(
         "--operating-score", options.operating_score,
         "score from which precision and false detections count; in-process, weaker ones are no candidates either; "
         "default: as hs-detect reports them, and candidates that have a pose")
      .range(range_of(&EvidenceSettings::threshold));
  add_min_quality_option(app, options.min_quality).description("in-process: least of a pose; default: hs-pose's");
  add_precision_option(
      app, options.rules.precision,
      "in-process, with --objects: each object's score and quality are what its practice needed for this precision")
      .excludes(app.get_option("--operating-score"))
      .excludes(app.get_option("--min-quality"));
  app.add_flag("--processed-only", rules.processed_only, "skipped frames are left out, not missed");
  app.add_option("--every", options.every, "look at every Nth frame only").range(1, 100000).capture_default_str();
  add_search_options(app, options.search);
  add_min_mass_option(app, options.search)
      .description("in-process: vote mass, over a whole object's, from which a maximum counts; default: the profile's");
}

}  // namespace

/// Returns the options with a store's forest and models, where one is named, and with what hs-detect publishes unless
/// told otherwise.
static EvaluateOptions with_store(EvaluateOptions options) {
  options.rules.operating_score = options.operating_score.value_or(EvidenceSettings{}.threshold);
  const std::optional<store::ObjectStore> store = resolve_store(options.known);
  options.pose = pose_settings_of(options.pose, store, options.min_quality);
  if (!options.rules.precision) return options;
  require_usage(store.has_value() && options.log.empty(),
                "--precision goes with --objects, whose practice it reads, and without --log");
  options.rules.class_operating_scores = with_precision({}, *store, options.rules.precision).class_thresholds;
  set_precision(*options.rules.precision, *store, options.pose);
  return options;
}

int evaluate_main(int argc, char** argv, const std::string& name, const EvaluateSearch& search) {
  CommandLine app("Compares detections and poses with the truth of a scene", name);
  EvaluateOptions options;
  options.in_process = search;
  add_options(app, options);
  search.add_options(app);
  app.add_example(name + " --scene SCENE --objects my.store --out RESULTS");
  return run_tool(app, argc, argv, [&] { run(with_store(options)); });
}

}  // namespace houghstream
