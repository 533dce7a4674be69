#include "pose/verification/equivalent_poses.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pose/seen/depth_score.hpp"
#include "pose/seen/foreground_evidence.hpp"
#include "pose/seen/handle_observation.hpp"

namespace houghstream {
namespace {

constexpr double kLogRatio = 2.0;  // log likelihood ratio of one observation of silhouette or handle that is sure

// The steps of find_equivalent_poses(); they stand behind it in the order of their calls.
std::vector<EquivalentPose> find_near_equivalents(const ObjectObservation& observation,
                                                  const Eigen::Isometry3d& T_camera_object,
                                                  const RenderedRegion& rendered, const DepthTolerance& tolerance,
                                                  const RegistrationSettings& registration);
void compare_silhouettes(const ObjectObservation& observation, const RenderedRegion& rendered,
                         const DepthTolerance& tolerance, std::vector<EquivalentPose>& alternatives);
bool stands_out(const ObjectObservation& observation, const Eigen::Isometry3d& T_camera_object,
                const RenderedRegion& other);
double silhouette_log_ratio(const ForegroundEvidence& foreground, const RenderedRegion& alternative,
                            const cv::Rect& image_px);

}  // namespace

std::vector<EquivalentPose> find_equivalent_poses(const ObjectObservation& observation,
                                                  const Eigen::Isometry3d& T_camera_object,
                                                  const RenderedRegion& rendered, const DepthTolerance& tolerance,
                                                  const RegistrationSettings& registration) {
  std::vector<EquivalentPose> poses =
      find_near_equivalents(observation, T_camera_object, rendered, tolerance, registration);
  for (const Eigen::Isometry3d& motion : observation.model.alternatives) poses.push_back({T_camera_object * motion});
  if (observation.model.partial_alternatives.empty()) return poses;
  constexpr double kMinLogRatio = -5.0;  // where the handle would be in plain sight, and is not
  const HandleObserver handle(observation, T_camera_object, rendered, tolerance);
  const HandleObservation observed = handle.observe_at(T_camera_object);
  if (observed.is_visible()) return poses;
  for (const Eigen::Isometry3d& motion : observation.model.partial_alternatives) {
    const Eigen::Isometry3d rotated = T_camera_object * motion;
    const HandleObservation there = handle.observe_at(rotated);
    const double log_ratio =
        kEvidenceTempering * kLogRatio / kObservationCells * (there.net_evidence() - observed.net_evidence());
    if (there.can_be_occluded() || log_ratio > kMinLogRatio) poses.push_back({rotated, log_ratio});
  }
  return poses;
}

namespace {

/// Returns nearly equivalent poses, registered, with what their silhouettes say.
std::vector<EquivalentPose> find_near_equivalents(const ObjectObservation& observation,
                                                  const Eigen::Isometry3d& T_camera_object,
                                                  const RenderedRegion& rendered, const DepthTolerance& tolerance,
                                                  const RegistrationSettings& registration) {
  constexpr int kPoints = 150;
  constexpr float kMinScoreRatio = 0.8F;
  const auto depth_score_at = [&](const Eigen::Isometry3d& pose) {
    return score_pose(observation.frame, observation.model, pose, kPoints, tolerance).value;
  };
  const float score = depth_score_at(T_camera_object);
  std::vector<EquivalentPose> poses;
  for (const Eigen::Isometry3d& motion : observation.model.near_alternatives) {
    const RegistrationResult moved = register_finely(
        observation, register_rotated(observation, T_camera_object * motion, registration), registration);
    if (moved.inliers > 0 && depth_score_at(moved.T_camera_object) >= kMinScoreRatio * score)
      poses.push_back({moved.T_camera_object});
  }
  if (!poses.empty()) compare_silhouettes(observation, rendered, tolerance, poses);
  return poses;
}

/// Sets the log ratio of each alternative to what the pixels say that the model covers at one of both poses only.
void compare_silhouettes(const ObjectObservation& observation, const RenderedRegion& rendered,
                         const DepthTolerance& tolerance, std::vector<EquivalentPose>& alternatives) {
  std::vector<std::pair<EquivalentPose*, RenderedRegion>> others;
  for (EquivalentPose& alternative : alternatives) {
    const Eigen::Isometry3d& pose = alternative.T_camera_object;
    if (stands_out(observation, pose, rendered))
      others.emplace_back(&alternative, render_depth_region(observation.model.mesh, pose, observation.frame.camera));
  }
  if (others.empty()) return;
  const ForegroundEvidence foreground(observation, rendered, tolerance, [&](const cv::Point& at_px) {
    return std::any_of(others.begin(), others.end(),
                       [&](const auto& other) { return !std::isnan(other.second.depth_at(at_px)); });
  });
  const cv::Rect image_px(cv::Point(), observation.frame.depth.size());
  for (const auto& [alternative, other] : others)
    alternative->log_ratio = silhouette_log_ratio(foreground, other, image_px);
}

/// Returns whether points of the model at a pose lie beside its silhouette at another one, rendered.
bool stands_out(const ObjectObservation& observation, const Eigen::Isometry3d& T_camera_object,
                const RenderedRegion& other) {
  constexpr int kPoints = 300;
  constexpr double kMinFraction = 0.005;  // what rounding to pixels leaves
  const ProjectedView projected = project_view(observation.frame, observation.model, T_camera_object, kPoints);
  int beside = 0;
  for (const ProjectedPoint& point : projected.points) {
    const cv::Point at(point.x, point.y);
    const bool is_beside = std::isnan(other.depth_at(at)) && std::isnan(other.depth_at(at + cv::Point(1, 1))) &&
                           std::isnan(other.depth_at(at - cv::Point(1, 1)));
    beside += is_beside ? 1 : 0;
  }
  return beside > kMinFraction * static_cast<double>(projected.points.size());
}

/// Returns the log likelihood ratio of an alternative to the pose at which the evidence was learnt.
double silhouette_log_ratio(const ForegroundEvidence& foreground, const RenderedRegion& alternative,
                            const cv::Rect& image_px) {
  const RenderedRegion& pose = foreground.rendered();
  const cv::Rect both = (pose.region_px | alternative.region_px) & image_px;
  if (both.area() == 0) return 0.0;
  double sum = 0.0;
  for (int y = both.y; y < both.br().y; ++y) {
    for (int x = both.x; x < both.br().x; ++x) {
      const cv::Point at(x, y);
      const float pose_depth = pose.depth_at(at);
      const float alternative_depth = alternative.depth_at(at);
      if (std::isnan(pose_depth) == std::isnan(alternative_depth)) continue;
      sum += std::isnan(pose_depth) ? foreground.at(at, alternative_depth, true) : -foreground.at(at, pose_depth, true);
    }
  }
  const double cell_px = static_cast<double>(std::max(both.width, both.height)) / kObjectCells;
  return kEvidenceTempering * kLogRatio / kObservationCells * sum / (cell_px * cell_px);
}

}  // namespace

}  // namespace houghstream
