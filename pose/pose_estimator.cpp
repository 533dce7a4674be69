#include "pose/pose_estimator.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/parallel.hpp"
#include "pose/registration/candidates.hpp"
#include "pose/registration/refinement.hpp"
#include "pose/registration/region.hpp"
#include "pose/registration/rotation_clusters.hpp"
#include "pose/verification/quality.hpp"

namespace houghstream {
namespace {

bool is_finite(const Eigen::Vector3f& centre_camera) {
  return centre_camera.allFinite() && centre_camera.z() > 0.0F;
}

/// Renders the model, compares, and publishes the pose or says why not.
PoseStatus judge_registered(const SeenRegion& seen, const ObjectModel& model, const Eigen::Isometry3d& T_camera_object,
                            const PoseSettings& settings, ObjectPose& pose) {
  const DepthTolerance tolerance{settings.verification.tolerance_m, settings.noise};
  const ViewLook look = look_at_view(seen.frame, model, T_camera_object, settings.registration.fine_points);
  const Verification depth = verify_pose(seen.frame, model.mesh, T_camera_object, tolerance);
  const PoseEvidence evidence{pose.detection_score, depth, compare_colours(seen.colours, look, tolerance)};
  const QualityTerms terms = quality_terms(evidence, settings.quality);
  pose.visible_fraction = depth.visible_fraction();
  pose.free_space_violation = depth.free_space_violation();
  pose.quality = pose_quality(terms, settings.quality);
  if (pose.quality < settings.quality.least) return reason_against(terms, settings.quality);
  pose.T_camera_object = T_camera_object;
  return PoseStatus::kValid;
}

ObjectPose estimate_one(const RgbdFrame& frame, const Detection& detection, const ObjectModel* model,
                        const ObjectPoses& earlier, const PoseSettings& settings) {
  ObjectPose pose;
  pose.class_id = detection.class_id;
  pose.class_name = detection.class_name;
  pose.detection_score = detection.score;
  pose.residual = std::numeric_limits<float>::quiet_NaN();
  const auto without = [&pose](PoseStatus status) {
    pose.status = status;
    return pose;
  };
  if (model == nullptr) return without(PoseStatus::kNoModel);
  if (detection.score < settings.min_score) return without(PoseStatus::kLowScore);
  if (!is_finite(detection.centre_camera)) return without(PoseStatus::kNoInitialPose);

  const DepthRegion region = find_region(frame, detection, *model, settings.region);
  if (region.points < settings.region.min_points) return without(PoseStatus::kTooFewPoints);

  const std::vector<RotationCandidate> rotations = rotation_clusters(detection.rotations, settings.initial);
  std::vector<PoseCandidate> candidates = place_candidates(frame, *model, detection.centre_camera, rotations, settings);
  const std::vector<PoseCandidate> warm = earlier_candidates(frame.id.utime, detection, earlier, settings.warm_start);
  candidates.insert(candidates.end(), warm.begin(), warm.end());
  if (candidates.empty()) return without(PoseStatus::kNoInitialPose);

  const SeenRegion seen{frame, lab_region(frame, region.box_px), region};
  const RegistrationResult registered =
      refine_candidates(seen, *model, detection.centre_camera, candidates, rotations, settings);
  pose.converged = registered.converged;
  pose.iterations = registered.iterations;
  pose.inliers = registered.inliers;
  pose.inlier_fraction = registered.inlier_fraction;
  pose.residual = registered.residual;
  if (registered.inliers == 0) return without(PoseStatus::kNotConverged);
  return without(judge_registered(seen, *model, registered.T_camera_object, settings, pose));
}

}  // namespace

struct PoseEstimator::State {
  std::map<std::string, ObjectModel> models;
  PoseSettings settings;
};

PoseEstimator::PoseEstimator(std::map<std::string, Mesh> models, PoseSettings settings)
    : state_(std::make_unique<State>()) {
  for (auto& model : models) {
    state_->models.emplace(model.first, make_object_model(model.first, std::move(model.second), settings.model));
  }
  state_->settings = settings;
}

PoseEstimator::~PoseEstimator() = default;
PoseEstimator::PoseEstimator(PoseEstimator&&) noexcept = default;

ObjectPoses PoseEstimator::estimate(const RgbdFrame& frame, const Detections& detections) const {
  return estimate(frame, detections, {});
}

ObjectPoses PoseEstimator::estimate(const RgbdFrame& frame, const Detections& detections,
                                    const ObjectPoses& earlier) const {
  if (frame.id != detections.frame) {
    throw std::logic_error(
        fmt::format("detections of frame {} given with frame {}", to_string(detections.frame), to_string(frame.id)));
  }
  check_frame(frame, "pose estimation");
  StageClock clock;
  ObjectPoses result;
  result.frame = detections.frame;
  result.stages = detections.stages;
  const int count = static_cast<int>(detections.detections.size());
  result.poses.resize(detections.detections.size());
  parallel_for(state_->settings.threads, count, [&](int index) {
    const auto i = static_cast<std::size_t>(index);
    const Detection& detection = detections.detections[i];
    const auto model = state_->models.find(detection.class_name);
    const ObjectModel* known = model == state_->models.end() ? nullptr : &model->second;
    result.poses[i] = estimate_one(frame, detection, known, earlier, state_->settings);
    result.poses[i].detection_index = index;
  });
  clock.mark("pose.estimate");
  result.stages.insert(result.stages.end(), clock.times().begin(), clock.times().end());
  return result;
}

}  // namespace houghstream
