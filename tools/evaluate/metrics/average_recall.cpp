#include "tools/evaluate/metrics/average_recall.hpp"

#include <algorithm>
#include <functional>
#include <limits>

#include "pipeline/base/parallel.hpp"
#include "pose/model/symmetry.hpp"
#include "tools/common/progress_line.hpp"

namespace houghstream {
namespace {

std::vector<const GroundTruthObject*> targets_of(const EvaluatedFrame& frame, const std::string& class_name) {
  std::vector<const GroundTruthObject*> targets;
  for (const NamedObject& object : frame.objects) {
    const GroundTruthObject& truth = object.truth;
    const bool is_target = object.is_target.value_or(truth.visible_fraction >= kTargetVisibility);
    if (object.class_name == class_name && truth.has_pose && is_target) targets.push_back(&truth);
  }
  return targets;
}

/// Returns the strongest poses first, as many as there are targets.
std::vector<const ObjectPose*> strongest_poses(const EvaluatedFrame& frame, const std::string& class_name,
                                               std::size_t maximum) {
  std::vector<const ObjectPose*> poses;
  if (!frame.poses) return poses;
  for (const ObjectPose& pose : frame.poses->poses) {
    if (pose.class_name == class_name && pose.T_camera_object) poses.push_back(&pose);
  }
  std::stable_sort(poses.begin(), poses.end(),
                   [](const ObjectPose* a, const ObjectPose* b) { return a->detection_score > b->detection_score; });
  poses.resize(std::min(poses.size(), maximum));
  return poses;
}

/// Returns the classes that have targets in a frame, with the errors of their poses.
std::map<std::string, FrameErrors> measure_frame(const EvaluatedFrame& frame, const BopScene& scene,
                                                 const std::map<std::string, BopModel>& models) {
  std::map<std::string, FrameErrors> measured;
  std::optional<RgbdFrame> image;
  for (const auto& [name, model] : models) {
    const std::vector<const GroundTruthObject*> targets = targets_of(frame, name);
    if (targets.empty()) continue;
    FrameErrors& result = measured[name];
    result.targets = static_cast<int>(targets.size());
    for (const ObjectPose* pose : strongest_poses(frame, name, targets.size())) {
      if (!image) image = scene.read_frame(frame.image);
      std::vector<BopErrors>& row = result.errors.emplace_back();
      for (const GroundTruthObject* target : targets)
        row.push_back(bop_errors(model, *pose->T_camera_object, target->T_camera_object, *image));
    }
  }
  return measured;
}

using ErrorOf = std::function<double(const BopErrors&)>;

/// Returns the number of targets of a frame that have a correct pose.
int count_correct(const FrameErrors& frame, const ErrorOf& error_of, double threshold) {
  std::vector<bool> taken(static_cast<std::size_t>(frame.targets), false);
  int correct = 0;
  for (const std::vector<BopErrors>& row : frame.errors) {
    std::size_t best = row.size();
    double best_error = threshold;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const double error = error_of(row[i]);
      if (taken[i] || !(error < best_error)) continue;
      best = i;
      best_error = error;
    }
    if (best == row.size()) continue;
    taken[best] = true;
    ++correct;
  }
  return correct;
}

/// Returns the mean over the ten thresholds `step` to 10 `step`.
double mean_recall(const std::vector<FrameErrors>& frames, int targets, double step, const ErrorOf& error_of) {
  int correct = 0;
  for (std::size_t i = 1; i <= kBopSteps; ++i) {
    for (const FrameErrors& frame : frames) correct += count_correct(frame, error_of, step * static_cast<double>(i));
  }
  return targets > 0 ? static_cast<double>(correct) / static_cast<double>(kBopSteps) / targets
                     : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

std::map<std::string, BopModel> make_bop_models(const std::map<std::string, Mesh>& meshes, const BopModels& models) {
  std::map<std::string, BopModel> out;
  for (const auto& [object_id, diameter] : models.diameters) {
    const std::string& name = models.names.at(object_id);
    out[name] = {meshes.at(name), diameter, expand_symmetries(models.symmetries.at(object_id))};
  }
  return out;
}

ClassErrors measure_poses(const std::vector<EvaluatedFrame>& frames, const BopScene& scene,
                          const std::map<std::string, BopModel>& models, int threads) {
  std::vector<std::map<std::string, FrameErrors>> measured(frames.size());
  ProgressLine progress("errors of poses", static_cast<double>(frames.size()));
  parallel_for(threads, static_cast<int>(frames.size()), [&](int index) {
    const auto i = static_cast<std::size_t>(index);
    measured[i] = measure_frame(frames[i], scene, models);
    progress.add(1.0);
  });
  ClassErrors by_class;
  for (std::map<std::string, FrameErrors>& frame : measured) {
    for (auto& [name, errors] : frame) by_class[name].push_back(std::move(errors));
  }
  return by_class;
}

AverageRecall average_recall(const std::vector<FrameErrors>& frames) {
  AverageRecall out;
  for (const FrameErrors& frame : frames) out.targets += frame.targets;
  constexpr double kPixels = 5.0;
  out.mssd = mean_recall(frames, out.targets, bop_step(0), [](const BopErrors& errors) { return errors.mssd; });
  out.mspd = mean_recall(frames, out.targets, kPixels, [](const BopErrors& errors) { return errors.mspd; });
  for (std::size_t tau = 0; tau < kBopSteps; ++tau) {
    out.vsd += mean_recall(frames, out.targets, bop_step(0), [&](const BopErrors& errors) { return errors.vsd[tau]; });
  }
  out.vsd /= static_cast<double>(kBopSteps);
  out.mean = (out.vsd + out.mssd + out.mspd) / 3.0;
  return out;
}

LocalisationScores localisation_scores(const ClassErrors& errors) {
  LocalisationScores scores;
  std::vector<FrameErrors> all;
  for (const auto& [name, frames] : errors) {
    scores.by_class[name] = average_recall(frames);
    all.insert(all.end(), frames.begin(), frames.end());
  }
  scores.all = average_recall(all);
  return scores;
}

}  // namespace houghstream
