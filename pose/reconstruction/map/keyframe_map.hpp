#pragma once

#include <map>
#include <vector>

#include "pose/reconstruction/map/landmarks.hpp"
#include "pose/reconstruction/map/pose_graph.hpp"

namespace houghstream::reconstruction {

/// Holds a frame of the map.
struct Keyframe {
  RgbdFrame frame;
  int number = 0;  ///< number of the frame in its take, from 0 (a take: a recording of one object from many sides)
  FrameLevels levels;
  LevelPoints points;  ///< camera frame
  Landmarks landmarks;
  Eigen::Isometry3d T_camera_world = Eigen::Isometry3d::Identity();  ///< metres; world: z up from the table
};

/// Error of a loop before it was closed.
struct LoopClosureError {
  double shift_m = 0.0;    ///< shift of the world's origin, metres
  double angle_rad = 0.0;  ///< radians
};

/// Thresholds for the registration of two views.
struct MapSettings {
  double max_local_angle = 0.44;  ///< radians between views: a keyframe of the local map
  double max_loop_angle = 0.35;   ///< radians between views: a loop may be closed
  int min_loop_edges = 8;         ///< a loop is closed only with keyframes more than this many edges away in the graph
  int local_keyframes = 3;        ///< keyframes of the local map
  double min_inlier_fraction = 0.75;
  double min_visible_fraction = 0.25;
  double max_photometric_rms = 0.62;
  int coarsest = 2;                ///< level on which registration begins
  bool use_landmarks = true;       ///< landmarks of the surroundings; highlights of a rotating object yield false ones
  std::size_t min_landmarks = 12;  ///< minimum number in common with another frame to constrain a pose
  std::size_t min_deciding_landmarks = 30;  ///< minimum number in common with a keyframe to determine a pose alone
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();  ///< middle of the object, world frame
  std::optional<PlanePrior> plane;                   ///< prior of a static camera
  int threads = 1;
};

/// A subset of the keyframes, and their points in the world frame.
struct Submap {
  std::vector<int> keyframes;
  LevelPoints points;
};

/// A keyframe whose landmarks were matched with a frame.
struct LandmarkReobservation {
  int keyframe = 0;
  LandmarkMatch match;  ///< match from the keyframe's camera to the frame's
};

/// Limits of the registration of a frame to a submap.
struct RegistrationLimits {
  int coarsest = 0;          ///< level to begin on
  bool may_be_lost = false;  ///< the predicted pose may be far off: landmarks may contradict it
};

/// Keyframes of a take, the pose graph between them, and the local map to which the next frame is registered.
class KeyframeMap {
 public:
  /// Begins with existing `keyframes`, whose poses are nearly correct.
  explicit KeyframeMap(const MapSettings& settings, std::vector<Keyframe> keyframes = {})
      : settings_(settings), keyframes_(std::move(keyframes)) {}
  MapSettings& settings() { return settings_; }
  const MapSettings& settings() const { return settings_; }

  /// Adds a keyframe; `alignment` is its registration to the local map (unused for the first). Closes a loop where one
  /// is found, corrects all poses then, and returns the error of the loop.
  std::optional<LoopClosureError> add(Keyframe keyframe, const Alignment& alignment);

  /// Returns the points of the local map: keyframes whose views overlap most with a camera there, without those across
  /// an open loop.
  const LevelPoints& local_map(const Eigen::Isometry3d& T_camera_world);
  LevelPoints points_of(const std::vector<int>& keyframes) const;  ///< world frame

  /// Refines a frame's alignment with the local map by landmarks of the surroundings, which constrain the rotation
  /// where geometry and intensity do not (an untextured round object on an untextured table).
  Alignment constrain_by_landmarks(const FrameLevels& levels, const Landmarks& landmarks,
                                   const Alignment& alignment) const;

  /// Returns whether an alignment is accepted.
  bool is_accepted(const Alignment& alignment) const;
  /// Returns the angle between two views of the object, plus their difference in distance expressed as an angle,
  /// radians.
  double view_angle(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) const;
  /// Returns the keyframe whose view is nearest.
  int nearest(const Eigen::Isometry3d& T_camera_world) const;

  /// Registers all keyframes to their neighbours and optimises the pose graph, for so many rounds. The result is the
  /// same for any number of threads.
  void refine(int rounds);

  std::vector<Keyframe>& keyframes() { return keyframes_; }
  const std::vector<Keyframe>& keyframes() const { return keyframes_; }
  bool empty() const { return keyframes_.empty(); }

 private:
  std::vector<int> find_local_keyframes(const Eigen::Isometry3d& T_camera_world) const;
  Submap make_submap(std::vector<int> keyframes) const;
  std::vector<LandmarkReobservation> match_keyframes(const std::vector<int>& keyframes,
                                                     const Landmarks& landmarks) const;
  Alignment register_to_submap(const Submap& submap, const FrameLevels& levels,
                               const std::vector<LandmarkReobservation>& reobservations,
                               const Eigen::Isometry3d& T_predicted, const RegistrationLimits& limits) const;
  std::vector<PoseEdge> edges_from(int from, int coarsest,
                                   std::map<int, std::vector<LandmarkReobservation>>& reobservations) const;
  std::optional<LoopClosureError> close_loop(int last);
  void correct_poses();
  PoseEdge edge_between(int from, int to, const Matrix6& information) const;

  MapSettings settings_;
  std::vector<Keyframe> keyframes_;
  std::vector<PoseEdge> edges_;
  std::vector<int> graph_distances_;  ///< number of edges from each keyframe to the last one; -1: not connected
  Submap local_;
};

}  // namespace houghstream::reconstruction
