#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/base/settings_fields.hpp"
#include "pipeline/bus/sequence_tracker.hpp"
#include "pipeline/geometry/mesh.hpp"
#include "pipeline/geometry/symmetry.hpp"
#include "pipeline/types/detection.hpp"
#include "pipeline/types/frame.hpp"
#include "pipeline/types/object_pose.hpp"
#include "pipeline/types/placed_objects.hpp"
#include "pipeline/types/tracked_object.hpp"
#include "pose/motion/motion_filter.hpp"
#include "pose/seen/region.hpp"

namespace houghstream::tracks {

/// Describes a class of objects.
struct TrackModel {
  Mesh mesh;
  Symmetries symmetries;
  Eigen::AlignedBox3d bounds;                        ///< bounds of the mesh, object frame, metres
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< centre of the bounding box, object frame, metres
  double box_radius_m = 0.0;  ///< half the bounding box' diagonal; ObjectModel::radius is that of the farthest vertex
  Eigen::Vector3d vote_centre = Eigen::Vector3d::Zero();  ///< centre of its detections, object frame, metres
  int object_id = 0;                ///< number of the object in its store, from 1; 0 without a store
  std::vector<ObjectFrame> frames;  ///< frames that somebody has named on the object, sorted by name
};
using TrackModels = std::map<std::string, TrackModel>;

/// Returns TrackModel::centre of a class; the origin where it has no model. Objects are compared by the position of
/// this point: their origins may be at their feet, which half a turn takes to the top.
Eigen::Vector3d centre_of(const TrackModels& models, const std::string& name);

/// Returns TrackModel::box_radius_m of a class; that of a usual object where it has no model.
double radius_of(const TrackModels& models, const std::string& name);

/// Returns TrackModel::symmetries of a class; none where it has no model.
const Symmetries& symmetries_of(const TrackModels& models, const std::string& name);

/// Makes models by class name; those without known symmetries have none. Throws InputError naming a mesh without
/// triangles.
TrackModels make_track_models(std::map<std::string, Mesh> meshes, const std::map<std::string, Symmetries>& symmetries);

/// Returns the boxes and named frames of a world's objects, by their poses; those that are gone, and those without a
/// model, are left out.
ObjectPlacements place_objects(const WorldObjects& world, const TrackModels& models);

/// A frame of a camera with everything that the tracker gets of it.
struct FrameObservation {
  const ObjectPoses& poses;                ///< names the frame
  const Detections* detections = nullptr;  ///< detections of the frame, where they are known
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  /// Decodes the frame's depth, only where it is needed; returns null, or is empty, where there is none.
  std::function<const RgbdFrame*()> image = nullptr;
  /// Time of the frame of this camera that has arrived last; without it, that of the frame of the poses.
  std::optional<std::int64_t> newest_utime = std::nullopt;
  FrameNumber number = {};  ///< number of the frame from its source, where there is one
};

/// A pose that was measured in a frame, in the world.
struct PoseObservation {
  FrameId frame;
  int class_id = 0;
  std::string class_name;
  double quality = 0.0;  ///< probability that it is right
  PoseMeasurement measured;
};

/// Returns the valid poses of a frame in the world. Their covariance grows with the distance, more along the line of
/// sight than across it, and where little of an object is seen.
std::vector<PoseObservation> observe_poses(const ObjectPoses& poses, const Eigen::Isometry3d& T_world_camera,
                                           const TrackModels& models);

/// Returns the logit of a pose's quality, which is clamped to 0.02 and 0.98.
double quality_logit(double quality);

/// Settings that decide which hypothesis a measured pose belongs to, and when an object starts to move or comes to
/// rest.
struct PoseTrackSettings {
  MotionSettings motion;
  double same_rotation_rad = 0.44;  ///< poses rotated farther apart are two hypotheses
  /// Minimum gate for the distance of a measurement of a static object; 4 sigma if larger.
  double static_gate_m = 0.008;
  double static_gate_rad = 0.21;     ///< that gate for its rotation
  double rest_threshold_m = 0.004;   ///< an object rests when the halves of 0.4 s differ by less
  double rest_threshold_rad = 0.09;  ///< that threshold for its rotation
};

template <typename Visit>
void fields(const PoseTrackSettings& /*settings*/, const Visit& visit) {
  using S = PoseTrackSettings;
  visit(group("motion", &S::motion));
  visit(number("same_rotation_rad", &S::same_rotation_rad, 0, 3.2, "rad"));
  visit(number("static_gate_m", &S::static_gate_m, 0, 10, "m"));
  visit(number("static_gate_rad", &S::static_gate_rad, 0, 3.2, "rad"));
  visit(number("rest_threshold_m", &S::rest_threshold_m, 0, 10, "m"));
  visit(number("rest_threshold_rad", &S::rest_threshold_rad, 0, 3.2, "rad"));
}

/// Estimates the pose of one object over time. It has one or a few hypotheses, each with its own filter, so that no
/// average of two is ever published (such as a can's two rotations), and decides whether the object moves or is at
/// rest.
class PoseTrack {
 public:
  PoseTrack(const PoseObservation& first, const PoseTrackSettings& settings);

  /// Moves all hypotheses to a time.
  void predict(std::int64_t utime);
  /// Updates the hypothesis that the measured rotation belongs to, and decides whether the object moves.
  /// `has_contrary_depth`: depth has contradicted its pose since it was measured last; then one measurement elsewhere
  /// suffices for a motion.
  void update(const PoseObservation& pose, const Symmetries& symmetries, bool has_contrary_depth);

  const MotionFilter& filter() const { return hypotheses_[best_].filter; }
  /// Return the distance in metres from the nearest hypothesis to the measured position of the object's `centre`
  /// (object frame, metres), and the angle in radians to the nearest one up to symmetries.
  double distance(const PoseMeasurement& measured, const Symmetries& symmetries, const Eigen::Vector3d& centre) const;
  double angle(const PoseMeasurement& measured, const Symmetries& symmetries) const;

 private:
  struct Hypothesis {
    MotionFilter filter;
    double weight = 0.0;  ///< accumulated log odds of its measurements, which decay over seconds
  };
  struct ObserverHistory {
    std::deque<PoseMeasurement> outside_gates;  ///< recent measurements that lie outside the gates
    std::int64_t agreed_utime = 0;              ///< time of its last measurement within the gates; 0 for none
  };

  // These are the steps of update() in the order of their calls.
  std::size_t hypothesis_for(const PoseMeasurement& measured, const Symmetries& symmetries);
  void update_static(const PoseObservation& pose, bool has_contrary_depth, Hypothesis& hypothesis);
  bool can_trigger_motion(const std::string& channel, std::int64_t utime) const;
  void update_moving(const PoseMeasurement& measured, Hypothesis& hypothesis);

  PoseTrackSettings settings_;
  std::vector<Hypothesis> hypotheses_;
  std::size_t best_ = 0;
  std::int64_t weights_utime_ = 0;
  std::map<std::string, ObserverHistory> observers_;  // observers by camera channel
  std::deque<PoseMeasurement> recent_;                // while it moves
};

/// Holds an object, or a candidate for one.
struct Track {
  PoseTrack pose;
  /// 0: not confirmed; -1: to be removed, as its number went to another track or it is a duplicate.
  std::int64_t id = 0;
  int class_id = 0;
  std::string class_name = {};
  double log_odds = 0.0;    ///< log odds of its existence
  int observed_frames = 0;  ///< number of frames with a pose of it
  std::int64_t first_utime = 0;
  FrameId last_seen = {};
  TrackState state = TrackState::kVisible;
  std::string reason = {};
  std::int64_t deleted_utime = 0;       ///< 0 while it is present
  bool is_observed = false;             ///< a result of the current frame has a pose of it
  double free_space_violation_s = 0.0;  ///< time of free-space violation since its last pose

  bool is_present() const { return deleted_utime == 0; }
};

}  // namespace houghstream::tracks
