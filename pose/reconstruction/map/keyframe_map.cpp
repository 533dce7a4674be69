#include "pose/reconstruction/map/keyframe_map.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/base/parallel.hpp"
#include "pose/motion/twist.hpp"

namespace houghstream::reconstruction {
namespace {

std::vector<Eigen::Isometry3d> poses_of(const std::vector<Keyframe>& keyframes) {
  std::vector<Eigen::Isometry3d> poses;
  poses.reserve(keyframes.size());
  for (const Keyframe& keyframe : keyframes) poses.push_back(keyframe.T_camera_world);
  return poses;
}

LoopClosureError gap_between(const Eigen::Isometry3d& before, const Eigen::Isometry3d& after) {
  const Vector6 gap = local_coordinates_about_body(before.inverse() * after);
  return {gap.head<3>().norm(), gap.tail<3>().norm()};
}

}  // namespace

double KeyframeMap::view_angle(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) const {
  const Eigen::Vector3d from_a = a.inverse().translation() - settings_.middle;
  const Eigen::Vector3d from_b = b.inverse().translation() - settings_.middle;
  const double cosine = std::clamp(from_a.normalized().dot(from_b.normalized()), -1.0, 1.0);
  return std::acos(cosine) + std::abs(std::log(from_a.norm() / from_b.norm()));
}

bool KeyframeMap::is_good(const Alignment& alignment) const {
  return alignment.pairs >= 100 && alignment.inlier_fraction >= settings_.min_inlier_fraction &&
         alignment.visible_point_fraction >= settings_.min_visible_fraction &&
         alignment.photometric_rms <= settings_.max_photometric_rms;
}

int KeyframeMap::nearest(const Eigen::Isometry3d& T_camera_world) const {
  int best = -1;
  double minimum = 1e9;
  for (std::size_t k = 0; k < keyframes_.size(); ++k) {
    const double d = view_angle(T_camera_world, keyframes_[k].T_camera_world);
    if (d >= minimum) continue;
    minimum = d;
    best = static_cast<int>(k);
  }
  return best;
}

std::vector<int> KeyframeMap::local_keyframes_for(const Eigen::Isometry3d& T_camera_world) const {
  std::vector<std::pair<double, int>> ranked;
  for (std::size_t k = 0; k < keyframes_.size(); ++k) {
    if (steps_[k] < 0 || steps_[k] > settings_.loop_steps) continue;
    ranked.emplace_back(view_angle(T_camera_world, keyframes_[k].T_camera_world), static_cast<int>(k));
  }
  std::sort(ranked.begin(), ranked.end());
  std::vector<int> local;
  for (const auto& [d, k] : ranked) {
    if (static_cast<int>(local.size()) == settings_.local_keyframes) break;
    if (local.empty() || d < settings_.max_local_angle) local.push_back(k);
  }
  std::sort(local.begin(), local.end());
  return local;
}

LevelPoints KeyframeMap::points_of(const std::vector<int>& keyframes) const {
  LevelPoints points;
  for (const int k : keyframes) {
    const Keyframe& keyframe = keyframes_[static_cast<std::size_t>(k)];
    const Eigen::Isometry3f T_world_camera = keyframe.T_camera_world.inverse().cast<float>();
    points.resize(keyframe.points.size());
    for (std::size_t level = 0; level < points.size(); ++level) {
      for (SurfacePoint point : keyframe.points[level]) {
        point.point = T_world_camera * point.point;
        point.normal = T_world_camera.linear() * point.normal;
        if (point.on_table) {
          point.point.z() = 0.0F;
          point.normal = Eigen::Vector3f::UnitZ();
        }
        points[level].push_back(point);
      }
    }
  }
  return points;
}

const LevelPoints& KeyframeMap::local_map(const Eigen::Isometry3d& T_camera_world) {
  std::vector<int> local = local_keyframes_for(T_camera_world);
  if (local != local_.keyframes) local_ = part_of(std::move(local));
  return local_.points;
}

MapPart KeyframeMap::part_of(std::vector<int> keyframes) const {
  LevelPoints points = points_of(keyframes);
  return {std::move(keyframes), std::move(points)};
}

PoseEdge KeyframeMap::edge_between(int from, int to, const Matrix6& information) const {
  const Keyframe& a = keyframes_[static_cast<std::size_t>(from)];
  const Keyframe& b = keyframes_[static_cast<std::size_t>(to)];
  return {from, to, b.T_camera_world * a.T_camera_world.inverse(), information};
}

std::optional<LoopClosureError> KeyframeMap::add(Keyframe keyframe, const Alignment& alignment) {
  const int last = static_cast<int>(keyframes_.size());
  keyframes_.push_back(std::move(keyframe));
  for (const int reference : local_.keyframes)
    edges_.push_back(
        edge_between(reference, last, alignment.information / static_cast<double>(local_.keyframes.size())));
  steps_ = graph_distances(last, last + 1, edges_);
  const std::optional<LoopClosureError> gap = close_loop(last);
  if (gap) correct_poses();
  local_.keyframes.clear();
  return gap;
}

/// Returns the keyframes that share enough landmarks with a frame.
std::vector<LandmarkReobservation> KeyframeMap::match_keyframes(const std::vector<int>& keyframes,
                                                                const Landmarks& landmarks) const {
  std::vector<LandmarkReobservation> again;
  for (const int k : keyframes) {
    std::optional<LandmarkMatch> match = match_landmarks(keyframes_[static_cast<std::size_t>(k)].landmarks, landmarks);
    if (match && match->inliers.size() >= settings_.min_corners) again.push_back({k, std::move(*match)});
  }
  return again;
}

/// Corners that contradict the likely pose are mistaken, wallpaper for instance, unless it may be far off and many
/// agree.
Alignment KeyframeMap::register_to_part(const MapPart& part, const FrameLevels& levels,
                                        const std::vector<LandmarkReobservation>& again,
                                        const Eigen::Isometry3d& T_likely, const RegistrationLimits& limits) const {
  constexpr double kContradicts = 0.015;  // radians
  PoseConstraints holds{settings_.plane, {}};
  std::size_t maximum = 0;
  Eigen::Isometry3d T_by_corners = T_likely;
  for (const auto& [k, match] : again) {
    const Keyframe& keyframe = keyframes_[static_cast<std::size_t>(k)];
    const Eigen::Isometry3d T_world_camera = keyframe.T_camera_world.inverse();
    for (const auto& [before, now] : match.inliers) holds.corners.push_back({T_world_camera * before, now});
    if (match.inliers.size() <= maximum) continue;
    maximum = match.inliers.size();
    T_by_corners = match.T_b_a * keyframe.T_camera_world;
  }
  const auto contradict =
      std::count_if(holds.corners.begin(), holds.corners.end(),
                    [&](const LandmarkObservation& corner) { return bearing_error(corner, T_likely) > kContradicts; });
  AlignmentLimits alignment;
  alignment.coarsest = limits.coarsest;
  if (!settings_.use_landmarks) {
    const PoseConstraints plane{settings_.plane, {}};
    Alignment found = align_frame(part.points, levels, T_likely, plane, alignment);
    if (is_good(found) || !limits.may_be_lost || maximum == 0) return found;
    return align_frame(part.points, levels, T_by_corners, plane, alignment);
  }
  const bool contradicted = 2 * static_cast<std::size_t>(contradict) > holds.corners.size();
  const bool jumps = contradicted && limits.may_be_lost && maximum >= settings_.sure_corners;
  if (contradicted && !jumps) holds.corners.clear();
  return align_frame(part.points, levels, jumps ? T_by_corners : T_likely, holds, alignment);
}

Alignment KeyframeMap::constrain_by_landmarks(const FrameLevels& levels, const Landmarks& landmarks,
                                              const Alignment& alignment) const {
  std::vector<LandmarkReobservation> again;
  if (settings_.use_landmarks) again = match_keyframes(local_.keyframes, landmarks);
  const Alignment held = register_to_part(local_, levels, again, alignment.T_camera_world, {});
  return is_good(held) ? held : alignment;
}

std::optional<LoopClosureError> KeyframeMap::close_loop(int last) {
  constexpr int kMaxTries = 2;
  constexpr double kMaxShift_m = 0.2;
  const Keyframe& now = keyframes_[static_cast<std::size_t>(last)];
  std::vector<std::pair<double, int>> candidates;
  for (int k = 0; k < last; ++k) {
    const double d = view_angle(now.T_camera_world, keyframes_[static_cast<std::size_t>(k)].T_camera_world);
    if (steps_[static_cast<std::size_t>(k)] > settings_.loop_steps && d < settings_.max_loop_angle)
      candidates.emplace_back(d, k);
  }
  std::sort(candidates.begin(), candidates.end());
  if (candidates.size() > kMaxTries) candidates.resize(kMaxTries);
  for (const auto& [d, k] : candidates) {
    const Keyframe& old = keyframes_[static_cast<std::size_t>(k)];
    const std::vector<LandmarkReobservation> again = match_keyframes({k}, now.landmarks);
    const Alignment found =
        register_to_part(part_of({k}), now.levels, again, now.T_camera_world, {settings_.coarsest, true});
    const LoopClosureError gap = gap_between(now.T_camera_world, found.T_camera_world);
    if (!is_good(found) || gap.shift_m > kMaxShift_m) continue;
    edges_.push_back({k, last, found.T_camera_world * old.T_camera_world.inverse(), found.information});
    return gap;
  }
  return std::nullopt;
}

void KeyframeMap::correct_poses() {
  std::vector<Eigen::Isometry3d> poses = poses_of(keyframes_);
  optimise_pose_graph(edges_, poses);
  for (std::size_t k = 0; k < poses.size(); ++k) keyframes_[k].T_camera_world = poses[k];
  steps_ = graph_distances(static_cast<int>(keyframes_.size()) - 1, static_cast<int>(keyframes_.size()), edges_);
}

/// Registers a keyframe to its neighbours. `again` caches its landmark matches by neighbour, which are the same in all
/// rounds.
std::vector<PoseEdge> KeyframeMap::edges_from(int from, int coarsest,
                                              std::map<int, std::vector<LandmarkReobservation>>& again) const {
  constexpr std::size_t kNeighbours = 8;
  const Keyframe& one = keyframes_[static_cast<std::size_t>(from)];
  std::vector<std::pair<double, int>> near;
  for (int j = 0; j < static_cast<int>(keyframes_.size()); ++j) {
    const double d = view_angle(one.T_camera_world, keyframes_[static_cast<std::size_t>(j)].T_camera_world);
    if (j != from && d < 1.5 * settings_.max_local_angle) near.emplace_back(d, j);
  }
  std::sort(near.begin(), near.end());
  if (near.size() > kNeighbours) near.resize(kNeighbours);
  const MapPart own = part_of({from});
  std::vector<PoseEdge> edges;
  for (const auto& [d, j] : near) {
    const Keyframe& to = keyframes_[static_cast<std::size_t>(j)];
    const auto [corners, is_new] = again.try_emplace(j);
    if (is_new && settings_.use_landmarks) corners->second = match_keyframes(own.keyframes, to.landmarks);
    const Alignment alignment = register_to_part(own, to.levels, corners->second, to.T_camera_world, {coarsest, false});
    if (is_good(alignment))
      edges.push_back({from, j, alignment.T_camera_world * one.T_camera_world.inverse(), alignment.information});
  }
  return edges;
}

void KeyframeMap::refine(int rounds) {
  const int n = static_cast<int>(keyframes_.size());
  std::vector<std::map<int, std::vector<LandmarkReobservation>>> again(static_cast<std::size_t>(n));
  for (int round = 0; round < rounds; ++round) {
    std::vector<std::vector<PoseEdge>> found(static_cast<std::size_t>(n));
    parallel_for(settings_.threads, n, [&](int i) {
      const auto at = static_cast<std::size_t>(i);
      found[at] = edges_from(i, round == 0 ? 1 : 0, again[at]);
    });
    std::vector<PoseEdge> edges = edges_;
    for (PoseEdge& edge : edges) edge.information *= 0.05;  // keep together what has no other tie
    for (const auto& of_one : found) edges.insert(edges.end(), of_one.begin(), of_one.end());
    std::vector<Eigen::Isometry3d> poses = poses_of(keyframes_);
    optimise_pose_graph(edges, poses);
    for (std::size_t k = 0; k < poses.size(); ++k) keyframes_[k].T_camera_world = poses[k];
  }
  local_.keyframes.clear();
}

}  // namespace houghstream::reconstruction
