#pragma once

#include <Eigen/Geometry>

#include "pipeline/types/frame.hpp"
#include "pose/model/object_model.hpp"
#include "pose/model/view_look.hpp"
#include "pose/pose_settings.hpp"

namespace houghstream {

/// How the measured depth speaks for a pose, judged at the visible points of the model.
struct DepthScore {
  float agreeing = 0.0F;   ///< fraction of the points where measured and model depth agree
  float violating = 0.0F;  ///< fraction in front of what was measured: the camera saw through them
  float value = 0.0F;      ///< (agreeing - violating) times the view's silhouette: explained minus contradicted area
};

/// Judges the points that were looked at. Points behind what was measured (occluded),
/// without depth, or outside the image speak neither way.
DepthScore score_look(const ViewLook& seen, const DepthTolerance& tolerance);

/// The same for the first `points` points of the view nearest to the pose.
DepthScore score_pose(const RgbdFrame& frame, const ObjectModel& model, const Eigen::Isometry3d& T_camera_object,
                      int points, const DepthTolerance& tolerance);

/// A move of the pose along the line of sight, and how the depth speaks for the pose after it.
struct DepthShift {
  double shift_m = 0.0;
  DepthScore score;  ///< as score_pose would give it, but for the small change of scale
};

/// The shift within `reach` metres that makes most visible points agree; none where no point is within reach.
DepthShift best_depth_shift(const RgbdFrame& frame, const ObjectModel& model, const Eigen::Isometry3d& T_camera_object,
                            int points, double reach, const DepthTolerance& tolerance);

}  // namespace houghstream
