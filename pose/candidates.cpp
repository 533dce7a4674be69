#include "pose/candidates.hpp"

#include <algorithm>

#include "pose/depth_score.hpp"

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

}  // namespace houghstream
