#include "tools/studies/pose/pose_trials.hpp"

#include "pipeline/base/checks.hpp"
#include "tools/studies/recorded/pose_agreement.hpp"

namespace houghstream {
namespace {

void measure_errors(const ScoredModel& model, const Eigen::Isometry3d& T_ground_truth, PoseTrial& trial) {
  const Eigen::Isometry3d& T_estimated = *trial.T_camera_object;
  trial.strict = strict_error(model.surface, T_estimated, T_ground_truth) / model.surface.diameter;
  trial.add = add_error(model.surface.points, T_estimated, T_ground_truth) / model.surface.diameter;
  trial.add_s = add_s_error(model.surface.points, T_estimated, T_ground_truth) / model.surface.diameter;
  const PoseDifference difference = compare_poses(T_estimated, T_ground_truth, model.symmetries);
  trial.shift_m = difference.shift_m;
  trial.angle_deg = difference.angle_deg;
}

/// Against the object that the pose comes nearest to, if the frame has one of the class.
void measure_nearest(const EvaluatedFrame& frame, const ScoredModel& model, PoseTrial& trial) {
  for (const NamedObject& object : frame.objects) {
    if (object.class_name != trial.class_name || !object.truth.has_pose) continue;
    PoseTrial other = trial;
    measure_errors(model, object.truth.T_camera_object, other);
    if (!(trial.add_s <= other.add_s)) trial = other;  // unknown at first
  }
}

PoseTrial match_trial(const PoseRun& run, const MatchedDetection& judged, const ScoredModel& model) {
  const EvaluatedFrame& frame = run.frames[judged.frame];
  const Detection& detection = frame.detections->detections[judged.index];
  const ObjectPose& pose = frame.poses->poses[judged.index];
  PoseTrial trial;
  trial.scene = run.scene;
  trial.image = frame.image;
  trial.class_name = detection.class_name;
  trial.class_id = detection.class_id;
  trial.score = detection.score;
  trial.box_px = detection.box_px;
  trial.outcome = judged.outcome;
  trial.symmetric = model.surface.is_symmetric();
  trial.ms = run.ms[judged.frame][judged.index];
  trial.status = pose.status;
  trial.quality = pose.quality;
  trial.T_camera_object = pose.T_camera_object;
  const GroundTruthObject* truth =
      judged.outcome == MatchOutcome::kTruePositive ? &frame.objects[judged.object].truth : nullptr;
  if (truth != nullptr) {
    trial.visible_fraction = truth->visible_fraction;
    trial.distance_m = truth->T_camera_object.translation().z();
  }
  if (!pose.T_camera_object) return trial;
  if (truth != nullptr) {
    measure_errors(model, truth->T_camera_object, trial);
  } else {
    measure_nearest(frame, model, trial);
  }
  return trial;
}

}  // namespace

SceneModels load_scene_models(const std::filesystem::path& models, const std::set<std::string>& classes) {
  SceneModels out;
  const BopModels listed = read_bop_models(models);
  const std::map<std::string, Mesh> meshes = load_class_models(models);
  const std::map<std::string, BopModel> bop = make_bop_models(meshes, listed);
  for (const auto& [object_id, name] : listed.names) {
    if (classes.count(name) == 0 || listed.diameters.count(object_id) == 0) continue;
    const Symmetries& symmetries = listed.symmetries.at(object_id);
    out.meshes[name] = meshes.at(name);
    out.bop[name] = bop.at(name);
    out.scored[name] = {make_pose_model(meshes.at(name), symmetries), symmetries};
  }
  require(!out.meshes.empty(), "{}: no model of a class of the forest", models.string());
  return out;
}

std::vector<PoseTrial> match_run(const PoseRun& run, const std::map<std::string, ScoredModel>& models) {
  std::vector<PoseTrial> trials;
  for (const auto& [name, model] : models) {
    for (const MatchedDetection& judged : evaluate_class(run.frames, name, DetectionRules{}).judged) {
      const std::vector<NamedObject>& objects = run.frames[judged.frame].objects;
      if (judged.outcome == MatchOutcome::kTruePositive && !objects[judged.object].truth.has_pose) continue;
      trials.push_back(match_trial(run, judged, model));
    }
  }
  return trials;
}

}  // namespace houghstream
