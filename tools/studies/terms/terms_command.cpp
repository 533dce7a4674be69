#include <fmt/format.h>

#include <set>
#include <sstream>

#include "detector/forest/forest_file.hpp"
#include "detector/stages.hpp"
#include "pipeline/base/checks.hpp"
#include "tools/common/tool_main.hpp"
#include "tools/evaluate/class_names.hpp"
#include "tools/finder/search_arguments.hpp"
#include "tools/studies/commands.hpp"
#include "tools/studies/terms/term_study.hpp"

namespace {

using namespace houghstream;

struct StudyOptions {
  std::vector<std::string> forests;
  std::vector<std::string> groups;
  std::string out;
  int every = 1;
  terms::StudyRules rules;
  SearchOptions search;
};

/// Scenes that share a column.
struct SceneGroup {
  std::string name;
  std::vector<std::string> scenes;
};

SceneGroup parse_group(const std::string& text) {
  const std::size_t equals = text.find('=');
  require(equals != std::string::npos && equals > 0, "--group {}: expected NAME=SCENE,SCENE", text);
  SceneGroup group{text.substr(0, equals), {}};
  std::istringstream scenes(text.substr(equals + 1));
  for (std::string scene; std::getline(scenes, scene, ',');) group.scenes.push_back(scene);
  require(!group.scenes.empty(), "--group {}: no scene, expected NAME=SCENE,SCENE", text);
  return group;
}

std::vector<SceneGroup> parse_groups(const StudyOptions& options) {
  std::vector<SceneGroup> groups;
  std::set<std::string> names;
  for (const std::string& text : options.groups) {
    groups.push_back(parse_group(text));
    require(names.insert(groups.back().name).second, "--group {}: a second group of this name", text);
  }
  require(options.forests.size() == 1 || options.forests.size() == groups.size(),
          "--forest: {} for {} groups, expected one, or one for each group", options.forests.size(), groups.size());
  return groups;
}

std::vector<ScoredHypothesis> candidates_in(const SearchContext& search, const RgbdFrame& frame,
                                            DetectorWorkspace& workspace) {
  make_working_images(search, frame, workspace);
  compute_features(search, workspace);
  find_posteriors(search, workspace);
  return score_hypotheses(search, frame, find_hypotheses(search, workspace), workspace);
}

/// The candidates need no rotations.
DetectionSettings settings_of(const StudyOptions& options, const Forest& forest) {
  constexpr float kAboveAll = 2.0F;
  DetectionSettings settings = options.search.settings_for(forest);
  settings.evidence.threshold = kAboveAll;
  return settings;
}

terms::Group study(const StudyOptions& options, const SceneGroup& scenes, const std::string& forest_file) {
  const Forest forest = load_forest(forest_file);
  require(forest.scoring == Scoring::kEvidence && forest.features.handling != ScaleHandling::kScaleSpace,
          "{}: scores by votes alone, expected one that weighs evidence", forest_file);
  const DetectionSettings settings = settings_of(options, forest);
  const ForestIndex index(forest);
  const SearchContext search{index, settings};
  NamedSide known{"the forest " + forest_file, {}};
  terms::ModelsByClass models;
  for (const ObjectClass& object : forest.classes) {
    known.names.insert(object.name);
    models[object.name] = object.score_model;
  }
  terms::StudyRules rules = options.rules;
  rules.suppression = settings.suppression;
  terms::Group group;
  group.name = scenes.name;
  DetectorWorkspace workspace;
  for (const std::string& folder : scenes.scenes) {
    const BopScene scene(folder);
    std::vector<EvaluatedFrame> frames = read_ground_truth(scene, find_bop_names(folder));
    const NamedSide truth{"the scene " + folder, ground_truth_names(frames)};
    if (!truth.names.empty()) require_shared_name(known, truth);
    for (EvaluatedFrame& frame : every_nth(std::move(frames), options.every)) {
      const std::vector<ScoredHypothesis> candidates = candidates_in(search, scene.read_frame(frame.image), workspace);
      terms::add_frame(std::move(frame), candidates, models, rules, group);
    }
  }
  return group;
}

void run(const StudyOptions& options) {
  if (options.search.threshold)
    fail("--threshold {}: every candidate is looked at, expected --score or --false-score", *options.search.threshold);
  const std::vector<SceneGroup> wanted = parse_groups(options);
  std::vector<terms::Group> groups;
  groups.reserve(wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i)
    groups.push_back(study(options, wanted[i], options.forests[options.forests.size() == 1 ? 0 : i]));
  fmt::print("{}", terms::table(groups, options.rules));
  if (!options.out.empty()) write_json(terms::to_json(groups, options.rules), options.out);
}

}  // namespace

int houghstream::studies::terms_command(CommandLine& app, int argc, char** argv) {
  StudyOptions options;
  app.add_option("--forest", options.forests, "forest file; one, or one for each group in their order").required();
  app.add_option("--group", options.groups,
                 "NAME=SCENE,SCENE: BOP scene folders with the truth that share a column; the first is what the others "
                 "are compared with")
      .required();
  app.add_option("--out", options.out, "JSON file with all figures");
  app.add_option("--every", options.every, "look at every Nth frame only").range(1, 100000).capture_default_str();
  app.add_option("--min-visible", options.rules.min_visible, "less visible objects are passed over")
      .range(0.0, 1.0)
      .capture_default_str();
  app.add_option("--score", options.rules.score,
                 "score from which an object counts as reported; of stores hs-detect publishes from 0.65 on")
      .range(0.0, 1.0)
      .capture_default_str();
  app.add_option("--false-score", options.rules.false_score, "score from which false candidates are looked at")
      .range(0.0, 1.0)
      .capture_default_str();
  add_search_options(app, options.search);
  app.add_example("hs-study terms --forest my.forest --group rendered=SCENE_1,SCENE_2 --group recorded=SCENE_3");
  return run_tool(app, argc, argv, [&] { run(options); });
}
