#include "pose/pose_estimator.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include "pipeline/checks.hpp"
#include "pipeline/parallel.hpp"
#include "pose/candidates.hpp"
#include "pose/depth_score.hpp"
#include "pose/region.hpp"
#include "pose/registration.hpp"
#include "pose/rotation_clusters.hpp"
#include "pose/verification.hpp"

namespace houghstream {
namespace {

RegistrationResult register_once(const RgbdFrame& frame, const DepthRegion& region, const ObjectModel& model,
                                 const Eigen::Isometry3d& T_camera_object, const RegistrationStage& stage,
                                 const PoseSettings& settings) {
  if (settings.registration.method == Registration::kProjective) {
    return register_projective(frame, model, T_camera_object, stage, settings.registration);
  }
  return register_pcl(region_points(frame, region, stage.points), model, T_camera_object, stage, settings.registration);
}

/// Coarse on all candidates, fine on the one that the depth speaks for most. No inliers where none stayed near
/// `centre`.
RegistrationResult register_candidates(const RgbdFrame& frame, const DepthRegion& region, const ObjectModel& model,
                                       const Eigen::Vector3f& centre, const std::vector<PoseCandidate>& candidates,
                                       const PoseSettings& settings) {
  const RegistrationSettings& registration = settings.registration;
  const double end = DepthTolerance{registration.end_distance_m, settings.noise}.at(centre.z());
  const double start = std::max(end, registration.start_distance_m);
  const DepthTolerance tolerance{settings.verification.tolerance_m, settings.noise};
  const auto is_near = [&](const RegistrationResult& result) {
    const Eigen::Vector3d shift = result.T_camera_object.translation() - centre.cast<double>();
    return shift.norm() <= registration.max_shift_m;
  };
  RegistrationResult best;
  float best_score = -std::numeric_limits<float>::infinity();
  for (const PoseCandidate& candidate : candidates) {
    const RegistrationResult coarse =
        register_once(frame, region, model, candidate.T_camera_object,
                      {registration.coarse_iterations, registration.coarse_points, start, end}, settings);
    const float score = score_pose(frame, model, coarse.T_camera_object, registration.fine_points, tolerance).value;
    if (!is_near(coarse) || !(score > best_score)) continue;
    best = coarse;
    best_score = score;
  }
  if (best.inliers == 0) return best;
  RegistrationResult fine = register_once(frame, region, model, best.T_camera_object,
                                          {registration.fine_iterations, registration.fine_points, end, end}, settings);
  fine.iterations += best.iterations;
  return is_near(fine) ? fine : best;
}

bool is_finite(const Eigen::Vector3f& centre_camera) {
  return centre_camera.allFinite() && centre_camera.z() > 0.0F;
}

ObjectPose estimate_one(const RgbdFrame& frame, const Detection& detection, const ObjectModel* model,
                        const PoseSettings& settings) {
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
  if (!is_finite(detection.centre_camera)) return without(PoseStatus::kNoInitialPose);

  const DepthRegion region = find_region(frame, detection, *model, settings.region);
  if (region.points < settings.region.min_points) return without(PoseStatus::kTooFewPoints);

  const std::vector<RotationCandidate> rotations = rotation_clusters(detection.rotations, settings.initial);
  if (rotations.empty()) return without(PoseStatus::kNoInitialPose);
  const std::vector<PoseCandidate> candidates =
      place_candidates(frame, *model, detection.centre_camera, rotations, settings);

  const RegistrationResult registered =
      register_candidates(frame, region, *model, detection.centre_camera, candidates, settings);
  pose.converged = registered.converged;
  pose.iterations = registered.iterations;
  pose.inliers = registered.inliers;
  pose.inlier_fraction = registered.inlier_fraction;
  pose.residual = registered.residual;
  if (registered.inliers == 0) return without(PoseStatus::kNotConverged);

  const Verification verification =
      verify_pose(frame, model->mesh, registered.T_camera_object, {settings.verification.tolerance_m, settings.noise});
  pose.visible_fraction = verification.visible_fraction();
  pose.free_space_violation = verification.free_space_violation();
  if (!is_supported(verification, settings.verification)) return without(PoseStatus::kRejectedByDepth);
  pose.T_camera_object = registered.T_camera_object;
  return without(PoseStatus::kValid);
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
  if (frame.utime != detections.utime) {
    throw std::logic_error(fmt::format("detections of frame {} given with frame {}", detections.utime, frame.utime));
  }
  check_frame(frame, "pose estimation");
  StageClock clock;
  ObjectPoses result;
  result.utime = detections.utime;
  result.source_channel = detections.source_channel;
  result.stages = detections.stages;
  const int count = static_cast<int>(detections.detections.size());
  result.poses.resize(detections.detections.size());
  parallel_for(state_->settings.threads, count, [&](int index) {
    const auto i = static_cast<std::size_t>(index);
    const Detection& detection = detections.detections[i];
    const auto model = state_->models.find(detection.class_name);
    result.poses[i] =
        estimate_one(frame, detection, model == state_->models.end() ? nullptr : &model->second, state_->settings);
    result.poses[i].detection_index = index;
  });
  clock.mark("pose.estimate");
  result.stages.insert(result.stages.end(), clock.times().begin(), clock.times().end());
  return result;
}

}  // namespace houghstream
