#include "tools/evaluate/scene_figures.hpp"

#include <algorithm>

#include "tools/evaluate/metrics/average_recall.hpp"

namespace houghstream {
namespace {

/// The errors of a scene's poses, as published and with nothing withheld.
struct SceneErrors {
  ClassErrors published;
  ClassErrors nothing_withheld;
};

void join(const ClassErrors& errors, ClassErrors& all) {
  for (const auto& [name, frames] : errors) all[name].insert(all[name].end(), frames.begin(), frames.end());
}

bool anything_withheld_is_known(const std::vector<EvaluatedFrame>& frames) {
  return std::any_of(frames.begin(), frames.end(), [](const auto& frame) { return frame.unfiltered_poses; });
}

SceneErrors measure_scene(const OpenScene& it, const ScoredModels& models, const EvaluationRules& rules, int threads) {
  const std::vector<EvaluatedFrame> counted = counted_frames(it.frames, rules);
  SceneErrors errors;
  errors.published = measure_poses(counted, it.scene, models.bop, threads);
  if (anything_withheld_is_known(counted))
    errors.nothing_withheld = measure_poses(with_unfiltered_poses(counted), it.scene, models.bop, threads);
  return errors;
}

Evaluation evaluate_frames(const std::vector<EvaluatedFrame>& frames, const std::vector<std::string>& classes,
                           const ScoredModels& models, const EvaluationRules& rules, const SceneErrors& errors) {
  Evaluation evaluation = evaluate(frames, classes, models.scored, rules);
  if (models.scored.empty() || evaluation.frames_with_poses == 0) return evaluation;
  evaluation.localisation = localisation_scores(errors.published);
  if (anything_withheld_is_known(frames))
    evaluation.localisation_nothing_withheld = localisation_scores(errors.nothing_withheld);
  return evaluation;
}

}  // namespace

ScoredModels make_scored_models(const std::filesystem::path& folder, const std::map<std::string, Mesh>& meshes,
                                const std::vector<std::string>& classes) {
  ScoredModels models;
  if (meshes.empty()) return models;
  const BopModels listed = read_bop_models(folder);
  for (const auto& [object_id, symmetries] : listed.symmetries) {
    const std::string& name = listed.names.at(object_id);
    models.scored[name] = make_pose_model(meshes.at(name), symmetries);
  }
  for (auto& [name, model] : make_bop_models(meshes, listed)) {
    if (std::find(classes.begin(), classes.end(), name) != classes.end()) models.bop[name] = model;
  }
  return models;
}

SceneFigures measure_scenes(const std::vector<OpenScene>& scenes, const std::vector<std::string>& classes,
                            const ScoredModels& models, const EvaluationRules& rules, int threads) {
  SceneFigures figures;
  std::vector<EvaluatedFrame> frames;
  SceneErrors errors;
  for (const OpenScene& it : scenes) {
    const SceneErrors here = measure_scene(it, models, rules, threads);
    figures.scenes.push_back({scene_name(it.scene), evaluate_frames(it.frames, classes, models, rules, here)});
    frames.insert(frames.end(), it.frames.begin(), it.frames.end());
    join(here.published, errors.published);
    join(here.nothing_withheld, errors.nothing_withheld);
  }
  figures.all = evaluate_frames(frames, classes, models, rules, errors);
  return figures;
}

}  // namespace houghstream
