#include <fmt/format.h>

#include <set>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "tools/common/rounded.hpp"
#include "tools/common/tool_main.hpp"
#include "tools/evaluate/report.hpp"
#include "tools/studies/baselines/frame_budget.hpp"
#include "tools/studies/baselines/linemod_detector.hpp"
#include "tools/studies/baselines/linemod_tuning.hpp"
#include "tools/studies/commands.hpp"
#include "tools/train/training_sources.hpp"

namespace {

using namespace houghstream;
namespace fs = std::filesystem;

struct LinemodOptions {
  TrainingSources sources;
  LinemodTemplateSettings templates;
  LinemodSelection selection;
  EvaluationRules rules;
  std::vector<std::string> scenes;
  std::string out;
  std::size_t every = 1;
  double seconds = 0.0;
  bool tune = false;
};

std::vector<std::string> class_names(const std::vector<TrainingView>& views) {
  std::set<std::string> names;
  for (const TrainingView& view : views) {
    if (view.class_id != 0) names.insert(view.class_name);
  }
  return {names.begin(), names.end()};
}

std::string folder_name(const fs::path& scene) {
  return fs::weakly_canonical(scene).filename().string();
}

/// Detects in every Nth frame of the scene, or as many of them as time allows: returns ground truth and detections.
std::vector<EvaluatedFrame> detect_in_scene(const LinemodDetector& detector, const BopScene& scene,
                                            const LinemodOptions& options) {
  const std::vector<EvaluatedFrame> all = read_ground_truth(scene, find_bop_names(scene.folder()));
  std::vector<EvaluatedFrame> selected = every_nth(all, static_cast<int>(options.every));
  const std::vector<std::size_t> visited = visit_within(options.seconds, selected.size(), [&](std::size_t i) {
    selected[i].detections = detector.detect(scene.read_frame(selected[i].image));
    log_debug("{}: frame {} of {}, {} detections", scene.folder().string(), selected[i].image + 1, all.size(),
              selected[i].detections->detections.size());
  });
  if (visited.size() < selected.size())
    fmt::print("{}: cut, {} of {} frames in {} s\n", scene.folder().string(), visited.size(), selected.size(),
               options.seconds);
  std::vector<EvaluatedFrame> frames;
  frames.reserve(visited.size());
  for (const std::size_t i : visited) frames.push_back(std::move(selected[i]));
  return frames;
}

/// Opens the scenes before training, so that a wrong name is reported at once.
std::vector<BopScene> open_scenes(const LinemodOptions& options) {
  require(!options.scenes.empty() && !options.out.empty(), "expected --scene and --out, or --tune");
  std::vector<BopScene> scenes;
  std::set<std::string> names;
  for (const std::string& folder : options.scenes) {
    require(names.insert(folder_name(folder)).second, "--scene {}: two scenes of this folder name, expected one",
            folder);
    scenes.emplace_back(folder);
  }
  return scenes;
}

void evaluate_scenes(const LinemodOptions& options) {
  const std::vector<BopScene> scenes = open_scenes(options);
  const std::vector<TrainingView> views = read_training_sources(options.sources);
  LinemodTemplateSettings templates = options.templates;
  templates.focal_px = static_cast<float>(scenes.front().images().front().camera.fx);
  StageClock clock;
  const LinemodDetector detector(views, templates, options.selection);
  clock.mark("train");
  const double train_seconds = static_cast<double>(clock.times().back().duration_us) * 1e-6;
  const LinemodTraining& training = detector.training();
  fmt::print("train_seconds {:.1f}\ntemplates {}\nrefused_templates {}\nrefused_views {}\n", train_seconds,
             training.templates, training.refused_templates, training.refused_views);
  for (const BopScene& scene : scenes) {
    const std::vector<EvaluatedFrame> frames = detect_in_scene(detector, scene, options);
    const Evaluation evaluation = evaluate(frames, class_names(views), {}, options.rules);
    fmt::print("\n{}\n{}", scene.folder().string(), summary_table(evaluation, options.rules));
    OrderedJson summary = summary_json(evaluation, options.rules, {});
    summary["linemod"] = {{"train_seconds", rounded(train_seconds, 3)},
                          {"templates", training.templates},
                          {"refused_templates", training.refused_templates},
                          {"refused_views", training.refused_views},
                          {"check_depth", options.selection.check_depth},
                          {"min_distance", rounded(options.templates.min_distance, 3)},
                          {"max_distance", rounded(options.templates.max_distance, 3)},
                          {"every", options.every},
                          {"frames", frames.size()}};
    write_report(evaluation, summary, fs::path(options.out) / folder_name(scene.folder()));
  }
}

void tune(const LinemodOptions& options) {
  fmt::print("features step weak templates check_depth AUC best_f1 at_score match_ms select_ms\n");
  constexpr int kImages = 60;
  tune_linemod(read_training_sources(options.sources), options.templates, options.selection, kImages,
               [](const LinemodTrial& trial) {
                 const std::string check = trial.selection.check_depth
                                               ? fmt::format("{:.2f}", trial.selection.depth_tolerance)
                                               : std::string("no");
                 fmt::print("{:>8} {:>4} {:>4} {:>9} {:>11} {:.3f} {:>7.3f} {:>8.3f} {:>8.0f} {:>9.0f}\n",
                            trial.templates.features, trial.templates.distance_step, trial.templates.weak_gradient,
                            trial.template_count, check, trial.auc, trial.best_f1, trial.best_score, trial.match_ms,
                            trial.selection_ms);
                 std::fflush(stdout);
               });
}

void add_options(CommandLine& app, LinemodOptions& options) {
  TrainingSources& sources = options.sources;
  app.add_option("--views", sources.views, "training views: bop:DIR or uw:DIR").required();
  app.add_option("--background", sources.backgrounds, "rooms without the objects: bop:DIR or images:DIR; for --tune");
  app.add_option("--instances", sources.instances, "instances of a uw: folder to teach").delimiter(',');
  app.add_option("--rename", sources.renames, "can_1=can: what an instance is called").delimiter(',');
  app.add_option("--camera", sources.camera, "WIDTHxHEIGHT,fx,fy,cx,cy, for data that publish none");
  app.add_option("--scene", options.scenes, "BOP scene folder with the truth; may be given several times");
  app.add_option("--every", options.every, "look at every Nth frame").range(1, 1000000).capture_default_str();
  app.add_option("--seconds", options.seconds, "look at as many frames of a scene as time is left for; 0: no limit")
      .range(0.0, 1e6)
      .capture_default_str();
  app.add_option("--out", options.out, "folder for SCENE/summary.json and SCENE/curves.csv");
  app.add_flag("--tune", options.tune, "print how a grid of settings fares on composed training pictures instead");
  app.add_flag("--check-depth", options.selection.check_depth, "drop matches where the scene is nearer or farther");
  app.add_option("--depth-tolerance", options.selection.depth_tolerance, "share of the distance").capture_default_str();
  app.add_option("--match-threshold", options.selection.match_threshold, "percent").capture_default_str();
  app.add_option("--features", options.templates.features, "per template and modality").capture_default_str();
  app.add_option("--weak-gradient", options.templates.weak_gradient, "colour gradients below are not looked at")
      .capture_default_str();
  app.add_option("--distance-step", options.templates.distance_step, "factor").capture_default_str();
  app.add_option("--min-distance", options.templates.min_distance, "of the scenes, metres").capture_default_str();
  app.add_option("--max-distance", options.templates.max_distance, "of the scenes, metres").capture_default_str();
  app.add_option("--threads", options.templates.threads).range(1, 256).capture_default_str();
  options.rules.operating_score = 0.96F;
  app.add_option("--operating-score", options.rules.operating_score,
                 "score from which precision and false detections count")
      .range(0.0, 1.0)
      .capture_default_str();
}

}  // namespace

int houghstream::studies::linemod_command(CommandLine& app, int argc, char** argv) {
  LinemodOptions options;
  add_options(app, options);
  app.add_example("hs-study linemod --views bop:VIEWS --scene SCENE --out OUT");
  return run_tool(app, argc, argv, [&] { options.tune ? tune(options) : evaluate_scenes(options); });
}
