#include "pose/turn_search.hpp"

#include <algorithm>
#include <cmath>

#include "pose/depth_score.hpp"

namespace houghstream {

ScoredPose judge_pose(const RgbdFrame& frame, const LabRegion& colours, const ObjectModel& model,
                      const Eigen::Isometry3d& T_camera_object, int points, const DepthTolerance& tolerance) {
  const float depth = score_pose(frame, model, T_camera_object, points, tolerance).value;
  return {T_camera_object,
          joint_score(depth, colour_agreement(frame, colours, model, T_camera_object, points, tolerance))};
}

namespace {

/// Those that are better than both neighbours; `ring`: the last one's next is the first.
std::vector<ScoredPose> summits(const std::vector<ScoredPose>& turns, bool ring) {
  std::vector<ScoredPose> best;
  const std::size_t count = turns.size();
  for (std::size_t i = 0; i < count; ++i) {
    const bool above_last = (i == 0 && !ring) || turns[i].score >= turns[(i + count - 1) % count].score;
    const bool above_next = (i + 1 == count && !ring) || turns[i].score > turns[(i + 1) % count].score;
    if (above_last && above_next) best.push_back(turns[i]);
  }
  return best;
}

}  // namespace

std::vector<ScoredPose> best_turns(const RgbdFrame& frame, const LabRegion& colours, const ObjectModel& model,
                                   const Eigen::Isometry3d& T_camera_object, const TurnRange& range,
                                   const DepthTolerance& tolerance) {
  const Eigen::Vector3d middle = model.middle.cast<double>();
  const int steps = static_cast<int>(std::floor(range.reach_rad / range.step_rad + 1e-9));
  const bool all_round = 2.0 * range.reach_rad >= 2.0 * M_PI - 1e-9;  // then both ends are one pose
  std::vector<ScoredPose> turns;
  for (int i = -steps; i <= steps - (all_round ? 1 : 0); ++i) {
    Eigen::Isometry3d turned = T_camera_object;
    turned.translate(middle);
    turned.rotate(Eigen::AngleAxisd(i * range.step_rad, Eigen::Vector3d::UnitZ()));
    turned.translate(-middle);
    turns.push_back(judge_pose(frame, colours, model, turned, range.points, tolerance));
  }
  std::vector<ScoredPose> best = summits(turns, all_round);
  std::stable_sort(best.begin(), best.end(),
                   [](const ScoredPose& a, const ScoredPose& b) { return a.score > b.score; });
  best.resize(std::min(best.size(), range.most));
  return best;
}

}  // namespace houghstream
