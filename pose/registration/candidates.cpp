#include "pose/registration/candidates.hpp"

#include <algorithm>

#include "pose/verification/depth_score.hpp"

namespace houghstream {
namespace {

PoseCandidate best_place(const RgbdFrame& frame, const ObjectModel& model, const Eigen::Isometry3d& T_camera_object,
                         const PoseSettings& settings) {
  const SearchSettings& search = settings.search;
  const DepthTolerance tolerance{search.tolerance_m, settings.noise};
  PoseCandidate best;
  for (int j = -search.steps; j <= search.steps; ++j) {
    for (int i = -search.steps; i <= search.steps; ++i) {
      Eigen::Isometry3d T = Eigen::Translation3d(i * search.step_m, j * search.step_m, 0.0) * T_camera_object;
      const DepthShift found = best_depth_shift(frame, model, T, search.points, search.reach_m, tolerance);
      T.translation() *= 1.0 + found.shift_m / T.translation().z();
      const bool first = i == -search.steps && j == -search.steps;
      if (first || found.score.value > best.score) best = {T, found.score.value};
    }
  }
  return best;
}

}  // namespace

std::vector<PoseCandidate> place_candidates(const RgbdFrame& frame, const ObjectModel& model,
                                            const Eigen::Vector3f& centre_camera,
                                            const std::vector<RotationCandidate>& rotations,
                                            const PoseSettings& settings) {
  std::vector<PoseCandidate> candidates;
  for (const RotationCandidate& rotation : rotations) {
    Eigen::Isometry3d T_camera_object = Eigen::Isometry3d::Identity();
    T_camera_object.linear() = rotation.R_camera_object.cast<double>().normalized().toRotationMatrix();
    T_camera_object.translation() = centre_camera.cast<double>();
    candidates.push_back(best_place(frame, model, T_camera_object, settings));
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const PoseCandidate& a, const PoseCandidate& b) { return a.score > b.score; });
  candidates.resize(std::min<std::size_t>(candidates.size(), std::max(1, settings.search.keep)));
  return candidates;
}

std::vector<PoseCandidate> earlier_candidates(std::int64_t utime, const Detection& detection,
                                              const ObjectPoses& earlier, const WarmStartSettings& settings) {
  std::vector<PoseCandidate> candidates;
  const double age_s = 1e-6 * static_cast<double>(utime - earlier.frame.utime);
  if (!(age_s > 0.0 && age_s <= settings.max_age_s)) return candidates;
  for (const ObjectPose& pose : earlier.poses) {
    if (!pose.T_camera_object || pose.class_name != detection.class_name) continue;
    const Eigen::Vector3d apart = pose.T_camera_object->translation() - detection.centre_camera.cast<double>();
    if (apart.norm() > settings.reach_m) continue;
    candidates.push_back({*pose.T_camera_object, 0.0F});
  }
  return candidates;
}

}  // namespace houghstream
