#include "pose/reconstruction/tracking/frame_follower.hpp"

#include <algorithm>

namespace houghstream::reconstruction {
namespace {

double agreement_of(const Alignment& alignment) {
  return alignment.inlier_fraction * std::min(1.0, alignment.visible_point_fraction / 0.4) -
         0.5 * alignment.photometric_rms;
}

}  // namespace

Alignment FrameFollower::register_to_map(const FrameLevels& levels, const Eigen::Isometry3d& T_start, int coarsest,
                                         KeyframeMap& map) const {
  AlignmentLimits limits;
  limits.coarsest = coarsest;
  return align_frame(map.local_map(T_start), levels, T_start, {map.settings().plane, corners_}, limits);
}

std::optional<Alignment> FrameFollower::follow(const FlowFrame& now, const FrameLevels& levels, const LastStep& step,
                                               Motion motion, KeyframeMap& map) {
  constexpr double kMaxRotation = 0.15;  // radians a frame, from rest
  constexpr double kMaxEver = 0.4;       // radians a frame
  constexpr double kMaxShift_m = 0.02;   // a frame, of an object that turns where it stands
  const Eigen::Isometry3d& T_last = step.T_last;
  const Eigen::Isometry3d T_goes_on = motion == Motion::kObject ? step.repeat_of_object() : step.repeat_of_camera();
  const int coarsest = map.settings().coarsest;
  const LevelPoints& points = map.local_map(T_last);
  const bool goes_on = agreement_of(compare_frame(points, levels, T_goes_on, coarsest)) >
                       agreement_of(compare_frame(points, levels, T_last, coarsest));
  const std::optional<LandmarkMatch> flow =
      motion == Motion::kObject ? std::nullopt : track_corners(last_flow_, detect_flow_corners(last_flow_, {}), now);
  corners_.clear();
  if (flow && flow->inliers.size() >= map.settings().min_corners) {
    for (const auto& [before, after] : flow->inliers) corners_.push_back({T_last.inverse() * before, after});
  }
  const Eigen::Isometry3d T_likely = !corners_.empty() ? flow->T_b_a * T_last : goes_on ? T_goes_on : T_last;
  Alignment best = register_to_map(levels, T_likely, coarsest, map);
  // Stripes and tiles repeat: what suddenly agrees less has slipped by one.
  if (!map.is_good(best) || best.photometric_rms > 1.4 * usual_light_rms_ + 0.03) {
    const Eigen::Isometry3d& T_else = goes_on ? T_last : T_goes_on;
    for (const Alignment& other :
         {register_to_map(levels, T_likely, 0, map), register_to_map(levels, T_else, coarsest, map),
          register_to_map(levels, T_else, 1, map)}) {
      if (agreement_of(other) > agreement_of(best)) best = other;
    }
  }
  const double maximum = std::min(kMaxRotation + 2.0 * map.view_angle(T_last, step.T_before), kMaxEver);
  const double shift = (T_last.inverse() * best.T_camera_world).translation().norm();
  const bool too_far = motion == Motion::kObject && shift > kMaxShift_m;
  if (!map.is_good(best) || too_far || map.view_angle(T_last, best.T_camera_world) > maximum) return std::nullopt;
  usual_light_rms_ += 0.2 * (best.photometric_rms - usual_light_rms_);
  return best;
}

}  // namespace houghstream::reconstruction
