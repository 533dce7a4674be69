#include "pose/reconstruction/tracking/frame_follower.hpp"

#include <algorithm>

namespace houghstream::reconstruction {
namespace {

double alignment_score(const Alignment& alignment) {
  return alignment.inlier_fraction * std::min(1.0, alignment.visible_point_fraction / 0.4) -
         0.5 * alignment.photometric_rms;
}

}  // namespace

Alignment FrameFollower::register_to_map(const FrameLevels& levels, const Eigen::Isometry3d& T_start, int coarsest,
                                         KeyframeMap& map) const {
  AlignmentLimits limits;
  limits.coarsest = coarsest;
  return align_frame(map.local_map(T_start), levels, T_start, {map.settings().plane, landmarks_}, limits);
}

std::optional<Alignment> FrameFollower::follow(const FlowFrame& flow_frame, const FrameLevels& levels,
                                               const LastStep& step, Motion motion, KeyframeMap& map) {
  constexpr double kMaxRotation_rad = 0.15;       // a frame, from rest
  constexpr double kMaxMovingRotation_rad = 0.4;  // a frame
  constexpr double kMaxShift_m = 0.02;            // a frame, of an object that turns where it stands
  const Eigen::Isometry3d& T_last = step.T_last;
  const Eigen::Isometry3d T_extrapolated =
      motion == Motion::kObject ? step.repeat_of_object() : step.repeat_of_camera();
  const int coarsest = map.settings().coarsest;
  const LevelPoints& points = map.local_map(T_last);
  const bool is_extrapolation_better = alignment_score(compare_frame(points, levels, T_extrapolated, coarsest)) >
                                       alignment_score(compare_frame(points, levels, T_last, coarsest));
  const std::optional<LandmarkMatch> flow =
      motion == Motion::kObject ? std::nullopt
                                : track_corners(last_flow_, detect_flow_corners(last_flow_, {}), flow_frame);
  landmarks_.clear();
  if (flow && flow->inliers.size() >= map.settings().min_landmarks) {
    for (const auto& [before, after] : flow->inliers) landmarks_.push_back({T_last.inverse() * before, after});
  }
  const Eigen::Isometry3d T_initial = !landmarks_.empty()       ? flow->T_b_a * T_last
                                      : is_extrapolation_better ? T_extrapolated
                                                                : T_last;
  Alignment best = register_to_map(levels, T_initial, coarsest, map);
  // Stripes and tiles repeat: if the photometric error grows suddenly, the pose has slipped by a period, and other
  // starts are tried.
  if (!map.is_accepted(best) || best.photometric_rms > 1.4 * mean_photometric_rms_ + 0.03) {
    const Eigen::Isometry3d& T_alternative = is_extrapolation_better ? T_last : T_extrapolated;
    for (const Alignment& other :
         {register_to_map(levels, T_initial, 0, map), register_to_map(levels, T_alternative, coarsest, map),
          register_to_map(levels, T_alternative, 1, map)}) {
      if (alignment_score(other) > alignment_score(best)) best = other;
    }
  }
  const double maximum =
      std::min(kMaxRotation_rad + 2.0 * map.view_angle(T_last, step.T_before), kMaxMovingRotation_rad);
  const double shift = (T_last.inverse() * best.T_camera_world).translation().norm();
  const bool too_far = motion == Motion::kObject && shift > kMaxShift_m;
  if (!map.is_accepted(best) || too_far || map.view_angle(T_last, best.T_camera_world) > maximum) return std::nullopt;
  mean_photometric_rms_ += 0.2 * (best.photometric_rms - mean_photometric_rms_);
  return best;
}

}  // namespace houghstream::reconstruction
