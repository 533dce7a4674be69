#include "tools/evaluate/in_process.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "detector/stages.hpp"
#include "pipeline/base/log_line.hpp"
#include "pose/pose_estimator.hpp"
#include "tools/common/progress_line.hpp"
#include "tools/finder/stored_quality.hpp"

namespace houghstream {
namespace {

PoseEstimator make_estimator(const std::map<std::string, Mesh>& models, PoseSettings settings, int threads) {
  settings.threads = threads;
  return {models, std::move(settings)};
}

/// Returns `settings` with thresholds that find all that would be published.
DetectionSettings finding_all(DetectionSettings settings, const PublishingRules& rules) {
  float& threshold = settings.evidence.threshold;
  threshold = std::min({threshold, rules.score, rules.candidates_from});
  for (const auto& [name, score] : rules.class_scores) threshold = std::min(threshold, score);
  settings.evidence.class_thresholds.clear();
  return settings;
}

DetectionSettings as_published(DetectionSettings settings, const PublishingRules& rules) {
  settings.evidence.threshold = rules.score;
  settings.evidence.class_thresholds = rules.class_scores;
  settings.evidence.candidates_from = rules.candidates_from;
  return settings;
}

/// Some of the detections of a frame, and the index of each among all.
struct DetectionSubset {
  Detections detections;
  std::vector<std::size_t> places;

  void add(const Detections& all, std::size_t index) {
    detections.detections.push_back(all.detections[index]);
    places.push_back(index);
  }
};

/// Returns the detections that would be sent to hs-pose: those that are reported, and the strongest candidates.
DetectionSubset sent_of(const Detections& all, const PublishingRules& rules, int max_candidates) {
  DetectionSubset sent{{all.frame, {}, all.stages}, {}};
  for (std::size_t i = 0; i < all.detections.size(); ++i) {
    const Detection& it = all.detections[i];
    if (it.reported || (it.score >= rules.candidates_from && --max_candidates >= 0)) sent.add(all, i);
  }
  return sent;
}

/// Puts the poses of some detections in their places among those of all.
void place_poses(std::vector<ObjectPose> found, const std::vector<std::size_t>& places, ObjectPoses& poses) {
  for (std::size_t i = 0; i < places.size(); ++i) {
    found[i].detection_index = static_cast<int>(places[i]);
    poses.poses[places[i]] = std::move(found[i]);
  }
}

/// Returns the published poses, in the places of their detections, among poses that say that the others' scores are too
/// low to be sent.
ObjectPoses with_unpublished(const Detections& all, ObjectPoses published, const std::vector<std::size_t>& places) {
  ObjectPoses poses{published.frame, {}, published.stages};
  for (std::size_t i = 0; i < all.detections.size(); ++i) {
    ObjectPose& pose = poses.poses.emplace_back();
    pose.class_id = all.detections[i].class_id;
    pose.class_name = all.detections[i].class_name;
    pose.detection_score = all.detections[i].score;
    pose.detection_index = static_cast<int>(i);
    pose.status = PoseStatus::kLowScore;
  }
  place_poses(std::move(published.poses), places, poses);
  return poses;
}

}  // namespace

struct InProcess::State {
  State(const std::map<std::string, Mesh>& models, const PublishingRules& published, int threads)
      : has_models(!models.empty()),
        estimator(make_estimator(models, published.pose, threads)),
        unfiltered(make_estimator(models, without_rejection(published.pose), threads)),
        rules(published) {}

  float ranked_from = 0.0F;
  int max_candidates = 0;
  FrameSearch search;
  FrameSearch publishing;  ///< search that publishes, where `search` finds more than is published
  bool has_models;
  PoseEstimator estimator;
  PoseEstimator unfiltered;
  PublishingRules rules;

  Detections detect(const RgbdFrame& frame) const {
    if (!publishing) return search(frame);
    const Detections timed = publishing(frame);
    Detections all = search(frame);
    all.stages = timed.stages;
    return all;
  }

  /// Returns the published poses, and those of the detections that have none of these.
  ObjectPoses estimate_all(const RgbdFrame& frame, const Detections& all, const ObjectPoses& published) const {
    DetectionSubset open{{all.frame, {}, {}}, {}};
    for (std::size_t i = 0; i < all.detections.size(); ++i) {
      if (!published.poses[i].T_camera_object) open.add(all, i);
    }
    ObjectPoses poses = published;
    place_poses(unfiltered.estimate(frame, open.detections).poses, open.places, poses);
    return poses;
  }
};

FrameSearch detector_search(std::vector<Forest> groups, const DetectionSettings& settings) {
  const auto detector = std::make_shared<const Detector>(std::move(groups), settings);
  const auto workspace = std::make_shared<DetectorWorkspace>();
  return [detector, workspace](const RgbdFrame& frame) { return detector->detect(frame, *workspace); };
}

InProcess::InProcess(std::vector<Forest> groups, const DetectionSettings& settings, const MakeSearch& make_search,
                     const std::map<std::string, Mesh>& models, const PublishingRules& rules)
    : state_(std::make_unique<State>(models, rules, settings.threads)) {
  const DetectionSettings all = finding_all(settings, rules);
  state_->ranked_from = all.evidence.threshold;
  state_->max_candidates = all.evidence.max_candidates;
  if (!models.empty() && all.evidence.threshold < std::min(rules.score, rules.candidates_from))
    state_->publishing = make_search(groups, as_published(settings, rules));
  state_->search = make_search(std::move(groups), all);
}

InProcess::~InProcess() = default;

float InProcess::ranked_from() const {
  return state_->ranked_from;
}

void InProcess::run(const BopScene& scene, std::vector<EvaluatedFrame>& frames) {
  ProgressLine progress("search", static_cast<double>(frames.size()));
  for (EvaluatedFrame& out : frames) {
    const RgbdFrame frame = scene.read_frame(out.image);
    Detections all = state_->detect(frame);
    const PublishingRules& rules = state_->rules;
    for (Detection& detection : all.detections)
      detection.reported = detection.score >= rules.score_of(detection.class_name);
    if (state_->has_models) {
      const DetectionSubset sent = sent_of(all, rules, state_->max_candidates);
      ObjectPoses published = with_unpublished(all, state_->estimator.estimate(frame, sent.detections), sent.places);
      out.unfiltered_poses = state_->estimate_all(frame, all, published);
      out.poses = std::move(published);
    }
    for (Detection& detection : all.detections) detection.rotations = {};
    log_debug("{} image {}: {} detections", out.scene, out.image_id, all.detections.size());
    out.detections = std::move(all);
    progress.add(1.0);
  }
}

}  // namespace houghstream
