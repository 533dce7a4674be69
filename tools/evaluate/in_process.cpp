#include "tools/evaluate/in_process.hpp"

#include <algorithm>
#include <optional>

#include "detector/stages.hpp"
#include "pipeline/base/log_line.hpp"
#include "pose/pose_estimator.hpp"

namespace houghstream {
namespace {

PoseEstimator make_estimator(const std::map<std::string, Mesh>& models, const PublishingRules& rules, float quality,
                             int threads) {
  PoseSettings settings = rules.pose;
  settings.threads = threads;
  settings.min_score = rules.pose_score;
  settings.quality.least = quality;
  for (auto& [name, learnt] : settings.class_quality) learnt.least = quality;
  return {models, settings};
}

/// The first ones, which are the strongest.
Detections from_score_on(Detections found, float score) {
  const auto is_weaker = [&](const Detection& detection) { return detection.score < score; };
  found.detections.erase(std::find_if(found.detections.begin(), found.detections.end(), is_weaker),
                         found.detections.end());
  return found;
}

/// Says of the detections behind those that were published that they were not.
void add_unpublished(const Detections& all, ObjectPoses& published) {
  for (std::size_t i = published.poses.size(); i < all.detections.size(); ++i) {
    ObjectPose& pose = published.poses.emplace_back();
    pose.class_id = all.detections[i].class_id;
    pose.class_name = all.detections[i].class_name;
    pose.detection_score = all.detections[i].score;
    pose.detection_index = static_cast<int>(i);
    pose.status = PoseStatus::kLowScore;
  }
}

}  // namespace

struct InProcess::State {
  Detector detector;
  std::optional<Detector> publishing;  ///< where `detector` finds weaker ones too
  bool has_models;
  PoseEstimator estimator;
  PoseEstimator withholding_none;
  PublishingRules rules;
  DetectorWorkspace workspace;

  Detections detect(const RgbdFrame& frame) {
    if (!publishing) return detector.detect(frame, workspace);
    const Detections timed = publishing->detect(frame, workspace);
    Detections all = detector.detect(frame, workspace);
    all.stages = timed.stages;
    return all;
  }

  /// The published poses, and those of the detections that have none of these.
  ObjectPoses estimate_all(const RgbdFrame& frame, const Detections& all, const ObjectPoses& published) const {
    Detections open{all.frame, {}, {}};
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < all.detections.size(); ++i) {
      if (published.poses[i].T_camera_object) continue;
      open.detections.push_back(all.detections[i]);
      places.push_back(i);
    }
    ObjectPoses poses = published;
    ObjectPoses found = withholding_none.estimate(frame, open);
    for (std::size_t i = 0; i < places.size(); ++i) {
      found.poses[i].detection_index = static_cast<int>(places[i]);
      poses.poses[places[i]] = std::move(found.poses[i]);
    }
    return poses;
  }
};

InProcess::InProcess(Forest forest, const DetectionSettings& settings, const Engine& engine,
                     const std::map<std::string, Mesh>& models, const PublishingRules& rules)
    : state_(std::make_unique<State>(State{Detector(std::move(forest), settings, engine),
                                           std::nullopt,
                                           !models.empty(),
                                           make_estimator(models, rules, rules.quality, settings.threads),
                                           make_estimator(models, rules, 0.0F, settings.threads),
                                           rules,
                                           {}})) {
  if (models.empty() || settings.evidence.threshold >= rules.score) return;
  DetectionSettings publishing = settings;
  publishing.evidence.threshold = rules.score;
  state_->publishing.emplace(state_->detector.forest(), publishing, engine);
}

InProcess::~InProcess() = default;

void InProcess::run(const BopScene& scene, std::vector<EvaluatedFrame>& frames) {
  for (EvaluatedFrame& out : frames) {
    const RgbdFrame frame = scene.read_frame(out.image);
    Detections all = state_->detect(frame);
    if (state_->has_models) {
      ObjectPoses published = state_->estimator.estimate(frame, from_score_on(all, state_->rules.score));
      add_unpublished(all, published);
      out.poses_nothing_withheld = state_->estimate_all(frame, all, published);
      out.poses = std::move(published);
    }
    for (Detection& detection : all.detections) detection.rotations = {};
    log_debug("{} image {}: {} detections", out.scene, out.image_id, all.detections.size());
    out.detections = std::move(all);
  }
}

}  // namespace houghstream
