#include "pose/registration/rotation_search.hpp"

#include <algorithm>
#include <cmath>

#include "pose/seen/colour_score.hpp"
#include "pose/seen/foreground_search.hpp"

namespace houghstream {
namespace {

/// Returns the poses that score higher than both neighbours; `ring`: the last one's next is the first.
std::vector<ScoredPose> local_maxima(const std::vector<ScoredPose>& rotations, bool ring) {
  std::vector<ScoredPose> best;
  const std::size_t count = rotations.size();
  for (std::size_t i = 0; i < count; ++i) {
    const bool above_last = (i == 0 && !ring) || rotations[i].score >= rotations[(i + count - 1) % count].score;
    const bool above_next = (i + 1 == count && !ring) || rotations[i].score > rotations[(i + 1) % count].score;
    if (above_last && above_next) best.push_back(rotations[i]);
  }
  return best;
}

Eigen::Isometry3d rotated(const Eigen::Isometry3d& T_camera_object, const ObjectModel& model, double angle_rad) {
  const Eigen::Vector3d middle = model.surface_median.cast<double>();
  const Eigen::AngleAxisd rotation(angle_rad, Eigen::Vector3d::UnitZ());
  return T_camera_object * Eigen::Translation3d(middle) * rotation * Eigen::Translation3d(-middle);
}

}  // namespace

ScoredPose score_pose_jointly(const ObjectObservation& observation, const Eigen::Isometry3d& T_camera_object,
                              int points, const DepthTolerance& tolerance) {
  const ProjectedView projected = project_view(observation.frame, observation.model, T_camera_object, points);
  const float depth = score_projected_view(projected, tolerance).value;
  const float score = joint_score(depth, compare_colours(observation.colours, projected, tolerance));
  const float share = observation.foreground ? 0.5F + 0.5F * mean_evidence(*observation.foreground, projected) : 1.0F;
  return {T_camera_object, share * score};
}

ScoredPose hill_climb_pose(const ObjectObservation& observation, const Eigen::Isometry3d& T_camera_object,
                           const HillClimb& hill_climb, const DepthTolerance& tolerance) {
  ScoredPose best = score_pose_jointly(observation, T_camera_object, hill_climb.points, tolerance);
  constexpr int kMotions = 8;
  double size = 1.0;
  int failed = 0;  // one after the other, of this size
  for (int round = 0; round < hill_climb.rounds; ++round) {
    bool improved = false;
    for (int motion = 0; motion < kMotions && failed < kMotions; ++motion) {  // a ninth would repeat the first
      const double step = (motion % 2 == 0 ? 1.0 : -1.0) * size;
      Eigen::Isometry3d moved = best.T_camera_object;
      if (motion < 2) {
        moved = rotated(moved, observation.model, step * hill_climb.step_rad);
      } else {
        moved.translate(step * hill_climb.step_m * Eigen::Vector3d::Unit(motion / 2 - 1));
      }
      const ScoredPose next = score_pose_jointly(observation, moved, hill_climb.points, tolerance);
      ++failed;
      if (!(next.score > best.score)) continue;
      best = next;
      improved = true;
      failed = 0;
    }
    if (improved) continue;
    size *= 0.5;
    failed = 0;
  }
  return best;
}

std::vector<ScoredPose> best_rotations_about_z(const ObjectObservation& observation,
                                               const Eigen::Isometry3d& T_camera_object, const RotationRange& range,
                                               const DepthTolerance& tolerance) {
  const int steps = static_cast<int>(std::floor(range.reach_rad / range.step_rad + 1e-9));
  const bool all_round = 2.0 * range.reach_rad >= 2.0 * M_PI - 1e-9;  // then both ends are one pose
  std::vector<ScoredPose> rotations;
  for (int i = -steps; i <= steps - (all_round ? 1 : 0); ++i) {
    const Eigen::Isometry3d rotation = rotated(T_camera_object, observation.model, i * range.step_rad);
    rotations.push_back(score_pose_jointly(observation, rotation, range.points, tolerance));
  }
  std::vector<ScoredPose> best = local_maxima(rotations, all_round);
  std::stable_sort(best.begin(), best.end(),
                   [](const ScoredPose& a, const ScoredPose& b) { return a.score > b.score; });
  best.resize(std::min(best.size(), range.maximum));
  return best;
}

}  // namespace houghstream
