#include "tools/teach/mesh/quality_examples.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "pose/verification/swapped_texture.hpp"
#include "pose/verification/texture_comparison.hpp"
#include "tools/finder/stored_quality.hpp"

namespace houghstream::quality {
namespace {

PoseSettings unfiltered_settings(const PosedModels& models, int threads) {
  PoseSettings settings;
  settings.threads = threads;
  settings.learn_camera_colours = false;  // off, as scores are learnt: EvidenceSettings
  settings.compare_instances = false;     // qualities are learnt of the evidence for one pose
  settings.model.vote_centres = models.vote_centres;
  settings.model.symmetries = models.symmetries;
  settings.model.shape_symmetries = models.shape_symmetries;
  settings.region.tone = models.tone;
  return without_rejection(settings);
}

}  // namespace

std::vector<Example> label_examples(const FoundPoses& found, const std::map<std::string, PoseModel>& models) {
  std::vector<Example> examples;
  for (const auto& [name, model] : models) {
    for (const MatchedDetection& judged : match_detections(found.frames, name, DetectionRules{})) {
      const std::optional<PoseTerms>& terms = found.terms[judged.frame][judged.index];
      if (!terms || judged.outcome == MatchOutcome::kIgnored) continue;
      Example example;
      example.scene = found.scene;
      example.frame = judged.frame;
      example.terms = terms->own;
      example.score = judged.score;
      example.texture_margin = terms->texture_margin;
      if (judged.outcome == MatchOutcome::kTruePositive) {
        const EvaluatedFrame& frame = found.frames[judged.frame];
        const GroundTruthObject& truth = frame.objects[judged.object].truth;
        if (!truth.has_pose) continue;
        example.is_present = true;
        example.object = judged.object;
        const Eigen::Isometry3d& T_camera_object = *frame.poses->poses[judged.index].T_camera_object;
        example.is_correct = is_correct(model, T_camera_object, truth.T_camera_object);
        example.is_correct_up_to_shape = is_correct_up_to_shape(model, T_camera_object, truth.T_camera_object);
      }
      if (example.is_correct_up_to_shape) example.with_swapped_texture = terms->with_swapped_texture;
      examples.push_back(std::move(example));
    }
  }
  return examples;
}

UnfilteredPoseFinder::UnfilteredPoseFinder(const PosedModels& models, int threads)
    : settings_(unfiltered_settings(models, threads)), estimator_(models.meshes, settings_) {
  for (const auto& [name, mesh] : models.meshes) models_.emplace(name, make_object_model(name, mesh, settings_.model));
}

FoundPoses UnfilteredPoseFinder::find(const std::string& name, const BopScene& scene, const Detector& detector,
                                      int every) const {
  FoundPoses found{name, every_nth(read_ground_truth(scene, find_bop_names(scene.folder())), every), {}};
  for (EvaluatedFrame& truth : found.frames) {
    const RgbdFrame frame = scene.read_frame(truth.image);
    truth.detections = detector.detect(frame);
    found.terms.push_back(find_in(frame, truth));
  }
  return found;
}

std::vector<std::optional<PoseTerms>> UnfilteredPoseFinder::find_in(const RgbdFrame& frame,
                                                                    EvaluatedFrame& found) const {
  found.poses = estimator_.estimate(frame, *found.detections);
  return terms_of(frame, *found.detections, *found.poses);
}

std::vector<std::optional<PoseTerms>> UnfilteredPoseFinder::terms_of(const RgbdFrame& frame,
                                                                     const Detections& detections,
                                                                     const ObjectPoses& poses) const {
  std::vector<std::optional<PoseTerms>> all;
  const FrameContext seen_frame = make_frame_context(frame, settings_.region, settings_.noise);
  for (const ObjectPose& pose : poses.poses) {
    std::optional<PoseTerms>& terms = all.emplace_back();
    if (!pose.T_camera_object) continue;
    const Detection& detection = detections.detections[pose.detection_index];
    const ObjectObservation observation =
        observe_object(seen_frame, detection, models_.at(pose.class_name), settings_.region);
    const PoseEvidence own =
        gather_evidence(observation, *pose.T_camera_object, detection.score, settings_.verification);
    const std::optional<PoseEvidence> other =
        evidence_with_swapped_texture(observation, *pose.T_camera_object, own, settings_.verification);
    terms = PoseTerms{quality_terms(own, settings_.quality), std::nullopt, std::nullopt};
    const DepthTolerance tolerance{settings_.verification.tolerance_m, observation.noise};
    const std::optional<TextureComparison> texture =
        compare_with_alternatives(observation, *pose.T_camera_object, tolerance, settings_.registration);
    if (texture) terms->texture_margin = texture->margin;
    if (other) terms->with_swapped_texture = quality_terms(*other, settings_.quality);
    if (shape_quality(terms->own, settings_.quality) != pose.shape_quality) {
      throw std::logic_error(
          fmt::format("pose of {}: not judged by the evidence that is learnt from", pose.class_name));
    }
  }
  return all;
}

}  // namespace houghstream::quality
