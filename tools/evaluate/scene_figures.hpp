#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "drivers/datasets/bop_dataset.hpp"
#include "pipeline/geometry/mesh.hpp"
#include "tools/evaluate/evaluation.hpp"
#include "tools/evaluate/metrics/bop_errors.hpp"
#include "tools/evaluate/metrics/evaluated_frame.hpp"
#include "tools/evaluate/metrics/pose_metrics.hpp"
#include "tools/evaluate/report.hpp"

namespace houghstream {

/// A scene with its ground truth and the results.
struct OpenScene {
  BopScene scene;
  std::map<int, std::string> names;  ///< names of its objects, by id
  std::vector<EvaluatedFrame> frames;
};

/// Models for pose errors, by class name.
struct ScoredModels {
  std::map<std::string, PoseModel> scored;
  std::map<std::string, BopModel> bop;  ///< models of listed classes only
};

/// Makes the models of a folder's `meshes` (load_class_models()); empty where there are none. Throws InputError as
/// read_bop_models() does.
ScoredModels make_scored_models(const std::filesystem::path& folder, const std::map<std::string, Mesh>& meshes,
                                const std::vector<std::string>& classes);

/// The figures of all scenes together, and of each.
struct SceneFigures {
  Evaluation all;
  std::vector<SceneEvaluation> scenes;
};

/// Compares the scenes' results with their truth for the listed classes.
SceneFigures measure_scenes(const std::vector<OpenScene>& scenes, const std::vector<std::string>& classes,
                            const ScoredModels& models, const EvaluationRules& rules, int threads);

}  // namespace houghstream
