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

LoopClosureError loop_error_between(const Eigen::Isometry3d& before, const Eigen::Isometry3d& after) {
  const Vector6 loop_error = local_coordinates_about_body(before.inverse() * after);
  return {loop_error.head<3>().norm(), loop_error.tail<3>().norm()};
}

}  // namespace

double KeyframeMap::view_angle(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) const {
  const Eigen::Vector3d from_a = a.inverse().translation() - settings_.middle;
  const Eigen::Vector3d from_b = b.inverse().translation() - settings_.middle;
  const double cosine = std::clamp(from_a.normalized().dot(from_b.normalized()), -1.0, 1.0);
  return std::acos(cosine) + std::abs(std::log(from_a.norm() / from_b.norm()));
}

bool KeyframeMap::is_accepted(const Alignment& alignment) const {
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

std::vector<int> KeyframeMap::find_local_keyframes(const Eigen::Isometry3d& T_camera_world) const {
  std::vector<std::pair<double, int>> ranked;
  for (std::size_t k = 0; k < keyframes_.size(); ++k) {
    if (graph_distances_[k] < 0 || graph_distances_[k] > settings_.min_loop_edges) continue;
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
  std::vector<int> local = find_local_keyframes(T_camera_world);
  if (local != local_.keyframes) local_ = make_submap(std::move(local));
  return local_.points;
}

Submap KeyframeMap::make_submap(std::vector<int> keyframes) const {
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
  graph_distances_ = graph_distances(last, last + 1, edges_);
  const std::optional<LoopClosureError> loop_error = close_loop(last);
  if (loop_error) correct_poses();
  local_.keyframes.clear();
  return loop_error;
}

/// Returns the keyframes that share enough landmarks with a frame.
std::vector<LandmarkReobservation> KeyframeMap::match_keyframes(const std::vector<int>& keyframes,
                                                                const Landmarks& landmarks) const {
  std::vector<LandmarkReobservation> reobservations;
  for (const int k : keyframes) {
    std::optional<LandmarkMatch> match = match_landmarks(keyframes_[static_cast<std::size_t>(k)].landmarks, landmarks);
    if (match && match->inliers.size() >= settings_.min_landmarks) reobservations.push_back({k, std::move(*match)});
  }
  return reobservations;
}

/// Registers a frame to a submap. Landmarks that contradict the predicted pose are taken as false matches, as on
/// wallpaper, unless that pose may be far off and many landmarks agree.
Alignment KeyframeMap::register_to_submap(const Submap& submap, const FrameLevels& levels,
                                          const std::vector<LandmarkReobservation>& reobservations,
                                          const Eigen::Isometry3d& T_predicted,
                                          const RegistrationLimits& limits) const {
  constexpr double kContradicts = 0.015;  // radians
  PoseConstraints constraints{settings_.plane, {}};
  std::size_t maximum = 0;
  Eigen::Isometry3d T_by_landmarks = T_predicted;
  for (const auto& [k, match] : reobservations) {
    const Keyframe& keyframe = keyframes_[static_cast<std::size_t>(k)];
    const Eigen::Isometry3d T_world_camera = keyframe.T_camera_world.inverse();
    for (const auto& [in_keyframe, in_frame] : match.inliers)
      constraints.landmarks.push_back({T_world_camera * in_keyframe, in_frame});
    if (match.inliers.size() <= maximum) continue;
    maximum = match.inliers.size();
    T_by_landmarks = match.T_b_a * keyframe.T_camera_world;
  }
  const auto contradicting = std::count_if(
      constraints.landmarks.begin(), constraints.landmarks.end(),
      [&](const LandmarkObservation& landmark) { return bearing_error(landmark, T_predicted) > kContradicts; });
  AlignmentLimits alignment;
  alignment.coarsest = limits.coarsest;
  if (!settings_.use_landmarks) {
    const PoseConstraints plane{settings_.plane, {}};
    Alignment found = align_frame(submap.points, levels, T_predicted, plane, alignment);
    if (is_accepted(found) || !limits.may_be_lost || maximum == 0) return found;
    return align_frame(submap.points, levels, T_by_landmarks, plane, alignment);
  }
  const bool is_contradicted = 2 * static_cast<std::size_t>(contradicting) > constraints.landmarks.size();
  const bool is_replaced = is_contradicted && limits.may_be_lost && maximum >= settings_.min_deciding_landmarks;
  if (is_contradicted && !is_replaced) constraints.landmarks.clear();
  return align_frame(submap.points, levels, is_replaced ? T_by_landmarks : T_predicted, constraints, alignment);
}

Alignment KeyframeMap::constrain_by_landmarks(const FrameLevels& levels, const Landmarks& landmarks,
                                              const Alignment& alignment) const {
  std::vector<LandmarkReobservation> reobservations;
  if (settings_.use_landmarks) reobservations = match_keyframes(local_.keyframes, landmarks);
  const Alignment constrained = register_to_submap(local_, levels, reobservations, alignment.T_camera_world, {});
  return is_accepted(constrained) ? constrained : alignment;
}

std::optional<LoopClosureError> KeyframeMap::close_loop(int last) {
  constexpr int kMaxTries = 2;
  constexpr double kMaxShift_m = 0.2;
  const Keyframe& latest = keyframes_[static_cast<std::size_t>(last)];
  std::vector<std::pair<double, int>> candidates;
  for (int k = 0; k < last; ++k) {
    const double d = view_angle(latest.T_camera_world, keyframes_[static_cast<std::size_t>(k)].T_camera_world);
    if (graph_distances_[static_cast<std::size_t>(k)] > settings_.min_loop_edges && d < settings_.max_loop_angle)
      candidates.emplace_back(d, k);
  }
  std::sort(candidates.begin(), candidates.end());
  if (candidates.size() > kMaxTries) candidates.resize(kMaxTries);
  for (const auto& [d, k] : candidates) {
    const Keyframe& candidate = keyframes_[static_cast<std::size_t>(k)];
    const std::vector<LandmarkReobservation> reobservations = match_keyframes({k}, latest.landmarks);
    const Alignment found = register_to_submap(make_submap({k}), latest.levels, reobservations, latest.T_camera_world,
                                               {settings_.coarsest, true});
    const LoopClosureError loop_error = loop_error_between(latest.T_camera_world, found.T_camera_world);
    if (!is_accepted(found) || loop_error.shift_m > kMaxShift_m) continue;
    edges_.push_back({k, last, found.T_camera_world * candidate.T_camera_world.inverse(), found.information});
    return loop_error;
  }
  return std::nullopt;
}

void KeyframeMap::correct_poses() {
  std::vector<Eigen::Isometry3d> poses = poses_of(keyframes_);
  optimise_pose_graph(edges_, poses);
  for (std::size_t k = 0; k < poses.size(); ++k) keyframes_[k].T_camera_world = poses[k];
  graph_distances_ =
      graph_distances(static_cast<int>(keyframes_.size()) - 1, static_cast<int>(keyframes_.size()), edges_);
}

/// Registers a keyframe to its neighbours. `reobservations` caches its landmark matches by neighbour, which are the
/// same in all rounds.
std::vector<PoseEdge> KeyframeMap::edges_from(int from, int coarsest,
                                              std::map<int, std::vector<LandmarkReobservation>>& reobservations) const {
  constexpr std::size_t kNeighbours = 8;
  const Keyframe& keyframe = keyframes_[static_cast<std::size_t>(from)];
  std::vector<std::pair<double, int>> neighbours;
  for (int j = 0; j < static_cast<int>(keyframes_.size()); ++j) {
    const double d = view_angle(keyframe.T_camera_world, keyframes_[static_cast<std::size_t>(j)].T_camera_world);
    if (j != from && d < 1.5 * settings_.max_local_angle) neighbours.emplace_back(d, j);
  }
  std::sort(neighbours.begin(), neighbours.end());
  if (neighbours.size() > kNeighbours) neighbours.resize(kNeighbours);
  const Submap single = make_submap({from});
  std::vector<PoseEdge> edges;
  for (const auto& [d, j] : neighbours) {
    const Keyframe& to = keyframes_[static_cast<std::size_t>(j)];
    const auto [landmarks, is_new] = reobservations.try_emplace(j);
    if (is_new && settings_.use_landmarks) landmarks->second = match_keyframes(single.keyframes, to.landmarks);
    const Alignment alignment =
        register_to_submap(single, to.levels, landmarks->second, to.T_camera_world, {coarsest, false});
    if (is_accepted(alignment))
      edges.push_back({from, j, alignment.T_camera_world * keyframe.T_camera_world.inverse(), alignment.information});
  }
  return edges;
}

void KeyframeMap::refine(int rounds) {
  const int n = static_cast<int>(keyframes_.size());
  std::vector<std::map<int, std::vector<LandmarkReobservation>>> reobservations(static_cast<std::size_t>(n));
  for (int round = 0; round < rounds; ++round) {
    std::vector<std::vector<PoseEdge>> found(static_cast<std::size_t>(n));
    parallel_for(settings_.threads, n, [&](int i) {
      const auto at = static_cast<std::size_t>(i);
      found[at] = edges_from(i, round == 0 ? 1 : 0, reobservations[at]);
    });
    std::vector<PoseEdge> edges = edges_;
    // These are weak edges that keep together keyframes without any other edge.
    for (PoseEdge& edge : edges) edge.information *= 0.05;
    for (const auto& keyframe_edges : found) edges.insert(edges.end(), keyframe_edges.begin(), keyframe_edges.end());
    std::vector<Eigen::Isometry3d> poses = poses_of(keyframes_);
    optimise_pose_graph(edges, poses);
    for (std::size_t k = 0; k < poses.size(); ++k) keyframes_[k].T_camera_world = poses[k];
  }
  local_.keyframes.clear();
}

}  // namespace houghstream::reconstruction
