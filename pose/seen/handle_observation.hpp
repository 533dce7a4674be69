#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "pose/seen/foreground_evidence.hpp"

namespace houghstream {

/// What the frame shows of a handle, the part that breaks a nearly round shape (ObjectModel::unround_points), at a
/// pose: sums over its points that face the camera, of which none counts more than one. Points that are occluded or
/// outside the image count 0.
struct HandleObservation {
  double agreeing = 0.0;       ///< evidence of points that the frame shows there
  double contradicting = 0.0;  ///< evidence of points where it shows something else
  int points = 0;              ///< all points that face the camera; 0 where the model has no handle

  /// Returns the agreeing less the contradicting evidence.
  double net_evidence() const { return agreeing - contradicting; }
  /// Returns net_evidence() as a fraction of the points, -1 to 1; 0 without a handle.
  double support() const;
  bool is_visible() const;       ///< more than a tenth agrees, and more than contradicts
  bool can_be_occluded() const;  ///< at most a tenth agrees, and at most a tenth contradicts
};

/// Observes the handle of an object at poses about one that was registered. The observation must outlive it.
class HandleObserver {
 public:
  /// `rendered` is the model at the registered pose.
  HandleObserver(const ObjectObservation& observation, const Eigen::Isometry3d& T_camera_object,
                 const RenderedRegion& rendered, const DepthTolerance& tolerance);
  HandleObserver(const ObjectObservation& observation, const Eigen::Isometry3d& T_camera_object,
                 const DepthTolerance& tolerance);

  HandleObservation observe_at(const Eigen::Isometry3d& T_camera_object) const;

  /// Turns the registered pose about the axis of the nearly round shape, all the way round, to where the frame supports
  /// the handle most. Returns nothing where the model has no handle, or no turn has clearly more support.
  std::optional<Eigen::Isometry3d> find_turn() const;

 private:
  /// Returns the evidence for a point of the handle. Where it lies before the rest of the object, which has its colour,
  /// depth alone tells them apart, and is blurred by a pixel: a neighbour may show it.
  double evidence_at(const cv::Point& at_px, double model_depth) const;

  const ObjectObservation& observation_;
  Eigen::Isometry3d T_camera_object_;
  std::optional<ForegroundEvidence> foreground_;  ///< nothing without a handle
};

}  // namespace houghstream
