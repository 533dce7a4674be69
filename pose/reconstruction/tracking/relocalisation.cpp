#include "pose/reconstruction/tracking/relocalisation.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace houghstream::reconstruction {
namespace {

/// Minimum fraction of inliers: a plane with texture on it may agree with a wrong pose by half.
constexpr double kSureInliers = 0.85;

/// Returns pairs of view angle and keyframe, the nearest first.
std::vector<std::pair<double, int>> keyframes_by_distance(const KeyframeMap& map,
                                                          const Eigen::Isometry3d& T_camera_world) {
  const std::vector<Keyframe>& keyframes = map.keyframes();
  std::vector<std::pair<double, int>> by_distance;
  for (std::size_t k = 0; k < keyframes.size(); ++k)
    by_distance.emplace_back(map.view_angle(T_camera_world, keyframes[k].T_camera_world), static_cast<int>(k));
  std::sort(by_distance.begin(), by_distance.end());
  return by_distance;
}

/// Registers the frame to the points of one keyframe; returns nothing where that is not reliable.
std::optional<Alignment> register_to_keyframe(const KeyframeMap& map, int keyframe, const FrameLevels& levels,
                                              const Eigen::Isometry3d& T_start) {
  AlignmentLimits limits;
  limits.coarsest = map.settings().coarsest;
  Alignment found = align_frame(map.points_of({keyframe}), levels, T_start, {map.settings().plane, {}}, limits);
  if (!map.is_accepted(found) || found.inlier_fraction <= kSureInliers) return std::nullopt;
  return found;
}

/// Matches a keyframe's landmarks with those of the frame.
const LandmarkCache::KeyframeMatch& match_keyframe(const KeyframeMap& map, int keyframe, LandmarkCache& cache) {
  const auto [known, is_new] = cache.by_keyframe.try_emplace(keyframe);
  LandmarkCache::KeyframeMatch& result = known->second;
  if (!is_new) return result;
  const Landmarks& of_keyframe = map.keyframes()[static_cast<std::size_t>(keyframe)].landmarks;
  if (const std::optional<LandmarkMatch> match = match_landmarks(of_keyframe, *cache.landmarks))
    result = {match->inliers.size(), match->T_b_a};
  return result;
}

}  // namespace

std::optional<Alignment> relocalise_by_neighbours(const KeyframeMap& map, const FrameLevels& levels,
                                                  const LastPose& last) {
  constexpr std::size_t kTried = 4;
  const std::vector<std::pair<double, int>> by_distance = keyframes_by_distance(map, last.T_camera_world);
  for (std::size_t i = 0; i < std::min(kTried, by_distance.size()); ++i) {
    const auto [distance, k] = by_distance[i];
    if (distance > last.max_view_angle) break;
    const Eigen::Isometry3d& T_start = map.keyframes()[static_cast<std::size_t>(k)].T_camera_world;
    if (std::optional<Alignment> found = register_to_keyframe(map, k, levels, T_start)) return found;
  }
  return std::nullopt;
}

std::optional<Alignment> Relocaliser::find(const KeyframeMap& map, const FrameLevels& levels, const LastPose& last,
                                           bool everywhere, LandmarkCache& cache) {
  const std::vector<Keyframe>& keyframes = map.keyframes();
  const std::vector<std::pair<double, int>> by_distance = keyframes_by_distance(map, last.T_camera_world);
  const std::size_t tried = everywhere ? keyframes.size() : 12;
  LandmarkCache::KeyframeMatch best;
  int best_keyframe = -1;
  for (std::size_t i = 0; i < std::min(tried, by_distance.size()); ++i) {
    // Half of the tries take the nearest keyframes, the rest the others in turn.
    const std::size_t at = i < tried / 2 ? i : next_to_try_++ % by_distance.size();
    const int k = by_distance[at].second;
    const LandmarkCache::KeyframeMatch& match = match_keyframe(map, k, cache);
    if (match.matches <= best.matches) continue;
    best = match;
    best_keyframe = k;
  }
  if (best_keyframe < 0 || best.matches < map.settings().min_deciding_landmarks) return std::nullopt;
  const Eigen::Isometry3d T = best.T_frame_keyframe * keyframes[static_cast<std::size_t>(best_keyframe)].T_camera_world;
  if (map.view_angle(T, last.T_camera_world) > last.max_view_angle) return std::nullopt;
  return register_to_keyframe(map, best_keyframe, levels, T);
}

}  // namespace houghstream::reconstruction
