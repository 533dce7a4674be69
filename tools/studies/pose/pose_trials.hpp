#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "pipeline/geometry/symmetry.hpp"
#include "tools/evaluate/metrics/average_recall.hpp"
#include "tools/evaluate/metrics/pose_metrics.hpp"
#include "tools/studies/pose/pose_trial.hpp"

namespace houghstream {

/// What the poses of a class are compared with the truth by.
struct ScoredModel {
  PoseModel surface;
  Symmetries symmetries;
};

/// The models of a scene by class name, metres.
struct SceneModels {
  std::map<std::string, Mesh> meshes;
  std::map<std::string, BopModel> bop;
  std::map<std::string, ScoredModel> scored;
};

/// Those of the listed classes; others are nobody's targets. Throws InputError for a folder that is no models/ of a BOP
/// dataset, or that has none of them.
SceneModels load_scene_models(const std::filesystem::path& models, const std::set<std::string>& classes);

/// Frames of a scene with detections and poses, one pose for each detection in their order.
struct PoseRun {
  std::string scene;
  std::vector<EvaluatedFrame> frames;
  std::vector<std::vector<double>> ms;  ///< by frame and detection
};

/// All detections that count, of the classes with a model, judged; those of objects whose truth has no pose are left
/// out. By class, then strongest first, so that the order is the same whoever made the poses.
std::vector<PoseTrial> judge_run(const PoseRun& run, const std::map<std::string, ScoredModel>& models);

}  // namespace houghstream
