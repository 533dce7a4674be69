#include <fmt/format.h>

#include <set>

#include "detector/forest/forest_file.hpp"
#include "drivers/datasets/bop_dataset.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/base/log_line.hpp"
#include "tools/common/tool_main.hpp"
#include "tools/evaluate/metrics/evaluated_frame.hpp"
#include "tools/finder/search_arguments.hpp"
#include "tools/studies/commands.hpp"
#include "tools/studies/quality/quality_fit.hpp"
#include "tools/teach/mesh/quality_examples.hpp"

namespace {

using namespace houghstream;

struct LearnOptions {
  std::string forest;
  std::vector<std::string> scenes;
  std::string models;
  std::string out;
  int every = 1;
  SearchOptions search;
};

/// Returns the models of the forest's classes, since others are never detected.
std::map<std::string, Mesh> models_of(const LearnOptions& options, const Forest& forest) {
  std::map<std::string, Mesh> known;
  const std::map<std::string, Mesh> all = load_class_models(options.models);
  for (const ObjectClass& object : forest.classes) {
    if (const auto found = all.find(object.name); found != all.end()) known.insert(*found);
  }
  require(!known.empty(), "{}: none of its {} models is of a class of {}", options.models, all.size(), options.forest);
  return known;
}

std::vector<quality::Example> gather(const LearnOptions& options) {
  Forest forest = load_forest(options.forest);
  const std::map<std::string, Mesh> meshes = models_of(options, forest);
  std::map<std::string, PoseModel> judged_by;
  const BopModels listed = read_bop_models(options.models);
  for (const auto& [object_id, symmetries] : listed.symmetries) {
    const auto mesh = meshes.find(listed.names.at(object_id));
    if (mesh != meshes.end()) judged_by[mesh->first] = make_pose_model(mesh->second, symmetries);
  }
  const Detector detector = detector_of(std::move(forest), options.search);
  const quality::UnfilteredPoseFinder finder({meshes, {}, load_class_symmetries(options.models)},
                                             options.search.threads);
  std::vector<quality::Example> examples;
  std::set<std::string> names;
  for (const std::string& folder : options.scenes) {
    const BopScene scene(folder);
    const std::string name = scene_name(scene);
    require(names.insert(name).second, "{}: a second scene of this name", folder);
    const quality::FoundPoses found = finder.find(name, scene, detector, options.every);
    const std::vector<quality::Example> here = quality::label_examples(found, judged_by);
    log_info("{}: {} frames, {} poses", name, found.frames.size(), here.size());
    examples.insert(examples.end(), here.begin(), here.end());
  }
  return examples;
}

void run(const LearnOptions& options) {
  const int scenes = static_cast<int>(options.scenes.size());
  require(scenes >= quality::kMinScenes, "--scene: {} scene{}, expected at least {} to judge each part by the others",
          scenes, scenes == 1 ? "" : "s", quality::kMinScenes);
  if (!options.out.empty()) require_writable(options.out);
  const quality::Learnt learnt = quality::learn_quality(gather(options));
  const quality::Published published = quality::published_from(learnt.checked, learnt.settings.min_quality);
  fmt::print(
      "// {} poses in {} scenes, {} right; from {:.2f} on {} of {} right in scenes that the fit has not seen\n"
      "// the numbers in use: {} of {} right\n{}",
      learnt.examples, learnt.scenes, learnt.correct, learnt.settings.min_quality, published.correct, published.poses,
      learnt.in_use.correct, learnt.in_use.poses, quality::to_initialisers(learnt.settings));
  if (!options.out.empty()) write_json(quality::to_json(learnt), options.out);
}

}  // namespace

int houghstream::studies::quality_command(CommandLine& app, int argc, char** argv) {
  LearnOptions options;
  options.search.threshold = PoseSettings{}.min_score;
  app.add_option("--forest", options.forest, "forest file").required();
  app.add_option("--scene", options.scenes, "BOP scene folder with the truth; at least four, whose truth decides")
      .required();
  app.add_option("--models", options.models, "models/ of a BOP dataset, millimetres").required();
  app.add_option("--out", options.out,
                 "JSON file with the numbers, and how many poses are right from which quality on");
  app.add_option("--every", options.every, "look at every Nth frame only").range(1, 100000).capture_default_str();
  add_search_options(app, options.search);
  app.get_option("--threshold").description("smallest score of a detection that is tried; default: 0.1");
  app.add_example("hs-study quality --forest my.forest --scene A B C D --models VIEWS/models");
  return run_tool(app, argc, argv, [&] { run(options); });
}
