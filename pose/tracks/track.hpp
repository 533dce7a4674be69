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
#include "pipeline/bus/sequence_count.hpp"
#include "pipeline/geometry/mesh.hpp"
#include "pipeline/geometry/symmetry.hpp"
#include "pipeline/types/detection.hpp"
#include "pipeline/types/frame.hpp"
#include "pipeline/types/object_pose.hpp"
#include "pipeline/types/tracked_object.hpp"
#include "pose/motion/motion_filter.hpp"
#include "pose/seen/region.hpp"

namespace houghstream::tracks {

/// What is known of a class of objects.
struct TrackModel {
  Mesh mesh;
  Symmetries symmetries;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< of the bounding box, object frame, metres
  double box_radius_m = 0.0;  ///< half the bounding box' diagonal; ObjectModel::radius is that of the farthest vertex
  Eigen::Vector3d vote_centre = Eigen::Vector3d::Zero();  ///< where its detections' centres are, object frame, metres
  int object_id = 0;                                      ///< of the object in its store, from 1; 0: it has no store
};
using TrackModels = std::map<std::string, TrackModel>;

/// TrackModel::centre of a class; the origin where it has no model. Objects are compared by where this point is: their
/// origins may be at their feet, which half a turn takes to the top.
Eigen::Vector3d centre_of(const TrackModels& models, const std::string& name);

/// TrackModel::box_radius_m of a class; that of a usual object where it has no model.
double radius_of(const TrackModels& models, const std::string& name);

/// TrackModel::symmetries of a class; none where it has no model.
const Symmetries& symmetries_of(const TrackModels& models, const std::string& name);

/// Models by class name; those without known symmetries have none. Throws InputError naming a mesh without triangles.
TrackModels make_track_models(std::map<std::string, Mesh> meshes, const std::map<std::string, Symmetries>& symmetries);

/// What is known of a frame of a camera.
struct FrameObservation {
  const ObjectPoses& poses;                ///< names the frame
  const Detections* detections = nullptr;  ///< of the frame, where they are known
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  std::function<const RgbdFrame*()> image =
      nullptr;  ///< its depth, asked only where it is needed; null where there is none
  /// Of the frame of this camera that has come last: without it, the frame of the poses.
  std::optional<std::int64_t> newest_utime = std::nullopt;
  FrameNumber number = {};  ///< of its source, as far as that says one
};

/// A pose that was measured in a frame, in the world.
struct PoseObservation {
  FrameId frame;
  int class_id = 0;
  std::string class_name;
  double quality = 0.0;  ///< probability that it is right
  PoseMeasurement measured;
};

/// The valid poses of a frame in the world. Their covariance grows with the distance, more along the line of sight than
/// across it, and where little of an object is seen.
std::vector<PoseObservation> observe_poses(const ObjectPoses& poses, const Eigen::Isometry3d& T_world_camera,
                                           const TrackModels& models);

/// Log odds of a pose's quality, which is cut to 0.02 and 0.98.
double log_odds_of(double quality);

/// How the depth of a frame speaks for an object at a pose.
struct Look {
  TrackState state = TrackState::kOutOfView;  ///< kUnrecognised: it agrees; kGone: it was seen through
  double seen_through = 0.0;                  ///< share of what is not hidden, 0 to 1
  bool goes_on = false;                       ///< the measured surface goes on where the object's outline is
};
Look look_at(const RgbdFrame& frame, const TrackModel& model, const Eigen::Isometry3d& T_camera_object);

/// When a measured pose belongs to a pose that is known, and when that moves.
struct PoseTrackSettings {
  MotionSettings motion;
  double same_rotation_rad = 0.44;  ///< poses turned farther apart are two hypotheses
  double static_gate_m = 0.008;     ///< what stands is not measured farther away than this, nor than 4 sigma
  double stands_rad = 0.21;
  double rest_threshold_m = 0.004;  ///< what moved stands when two fifths of a second differ by less
  double settles_rad = 0.09;
};

template <typename Visit>
void fields(const PoseTrackSettings& /*settings*/, const Visit& visit) {
  using S = PoseTrackSettings;
  visit(group("motion", &S::motion));
  visit(number("same_rotation_rad", &S::same_rotation_rad, 0, 3.2, "rad"));
  visit(number("static_gate_m", &S::static_gate_m, 0, 10, "m"));
  visit(number("stands_rad", &S::stands_rad, 0, 3.2, "rad"));
  visit(number("rest_threshold_m", &S::rest_threshold_m, 0, 10, "m"));
  visit(number("settles_rad", &S::settles_rad, 0, 3.2, "rad"));
}

/// The pose of one object over time: one or a few hypotheses of it, each with a filter of its own, so that no average
/// of two is ever published (a can's two turns), and what is needed to tell moving from standing.
class PoseTrack {
 public:
  PoseTrack(const PoseObservation& first, const PoseTrackSettings& settings);

  void predict(std::int64_t utime);
  /// `doubted`: depth has spoken against where it was since it was measured last; then one measurement elsewhere tells.
  void take(const PoseObservation& pose, const Symmetries& symmetries, bool doubted);

  const MotionFilter& filter() const { return hypotheses_[best_].filter; }
  /// Metres from the nearest hypothesis to where the measured pose has the object's `centre` (object frame, metres),
  /// and radians to the nearest one, of what looks the same.
  double distance(const PoseMeasurement& measured, const Symmetries& symmetries, const Eigen::Vector3d& centre) const;
  double angle(const PoseMeasurement& measured, const Symmetries& symmetries) const;

 private:
  struct Hypothesis {
    MotionFilter filter;
    double weight = 0.0;  ///< log odds of what spoke for it of late
  };
  struct ObserverHistory {
    std::deque<PoseMeasurement> apart;  ///< of late, where the object is not thought to be
    std::int64_t agreed_utime = 0;      ///< when it last saw it where it is
  };

  std::size_t hypothesis_for(const PoseMeasurement& measured, const Symmetries& symmetries);
  void update_standing(const PoseObservation& pose, bool doubted, Hypothesis& hypothesis);
  bool can_trigger_motion(const std::string& channel, std::int64_t utime) const;
  void update_moving(const PoseMeasurement& measured, Hypothesis& hypothesis);

  PoseTrackSettings settings_;
  std::vector<Hypothesis> hypotheses_;
  std::size_t best_ = 0;
  std::int64_t weighed_utime_ = 0;
  std::map<std::string, ObserverHistory> witnesses_;  // by camera
  std::deque<PoseMeasurement> recent_;                // while it moves
};

/// An object, or what may become one.
struct Track {
  PoseTrack pose;
  std::int64_t id = 0;  ///< 0: not confirmed
  int class_id = 0;
  std::string class_name = {};
  double log_odds = 0.0;  ///< that it is there
  int seen = 0;           ///< frames with a pose of it
  std::int64_t first_utime = 0;
  FrameId last_seen = {};
  TrackState state = TrackState::kVisible;
  std::string reason = {};
  std::int64_t deleted_utime = 0;  ///< 0: it is there
  bool seen_now = false;
  double seen_through_s = 0.0;  ///< for how long it was seen through, since it was seen last

  bool there() const { return deleted_utime == 0; }
};

}  // namespace houghstream::tracks
