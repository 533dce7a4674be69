#include "tools/studies/pose/surface_rival.hpp"

#include <limits>

#include "pose/seen/depth_score.hpp"
#include "pose/seen/region.hpp"

namespace houghstream {
namespace {

constexpr int kScoredPoints = 400;  // of the model's view

}  // namespace

SurfaceRival::SurfaceRival(const std::map<std::string, Mesh>& models, const PoseSettings& pose,
                           const SurfaceSettings& surface)
    : pose_(pose), surface_(surface) {
  for (const auto& [name, mesh] : models) models_.emplace(name, make_object_model(name, mesh, pose.model));
}

std::optional<Eigen::Isometry3d> SurfaceRival::estimate(const RgbdFrame& frame, const Detection& detection) const {
  check_frame(frame, "pose rival");
  const auto found = models_.find(detection.class_name);
  if (found == models_.end() || !detection.centre_camera.allFinite()) return std::nullopt;
  const ObjectModel& model = found->second;
  const DepthRegion region = find_region(frame, detection, model, pose_.region);
  if (region.points < pose_.region.min_points) return std::nullopt;

  SeenSurface seen{frame, model, region};
  seen.cloud = measured_surface(frame, region, surface_);
  seen.centre_camera = detection.centre_camera.cast<double>();
  seen.max_shift_m = pose_.registration.max_shift_m;
  std::optional<Eigen::Isometry3d> best;
  float best_score = -std::numeric_limits<float>::infinity();
  for (const Eigen::Isometry3d& T_camera_object : propose(found->first, seen)) {
    if (!T_camera_object.matrix().allFinite() || !seen.reaches(T_camera_object)) continue;
    const DepthTolerance tolerance{pose_.verification.tolerance_m, pose_.noise};
    const float score = score_pose(frame, model, T_camera_object, kScoredPoints, tolerance).value;
    if (score <= best_score) continue;
    best_score = score;
    best = T_camera_object;
  }
  return best;
}

}  // namespace houghstream
