#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <vector>

#include "pipeline/types/frame.hpp"
#include "pose/model/object_model.hpp"
#include "pose/seen/region.hpp"

namespace houghstream {

/// Default tolerance in metres within which measured and model depth agree.
constexpr double kDepthTolerance_m = 0.008;

/// A model point projected into the frame, with the difference between measured and predicted depth at its pixel.
struct ProjectedPoint {
  /// Measured minus model depth along the ray, metres; NaN where nothing was measured or the image ends.
  float depth_difference = std::numeric_limits<float>::quiet_NaN();
  int x = 0;  ///< pixel; meaningless where the image ends
  int y = 0;
};

/// Holds the projected points of a model's view at a pose.
struct ProjectedView {
  const ModelView& view;               ///< nearest to the pose
  Eigen::Isometry3f T;                 ///< camera from object
  double depth = 0.0;                  ///< depth of the model's middle, metres, at which tolerances are taken
  std::vector<ProjectedPoint> points;  ///< first points of the view, projected
};
ProjectedView project_view(const RgbdFrame& frame, const ObjectModel& model, const Eigen::Isometry3d& T_camera_object,
                           int points);

/// Score of a pose by the measured depth at the visible points of the model.
struct DepthScore {
  float inlier_fraction = 0.0F;       ///< fraction of the points where measured and model depth agree
  float free_space_violation = 0.0F;  ///< fraction in front of what was measured: the camera saw through them
  float value = 0.0F;  ///< (agreeing - violating) times the view's silhouette: explained minus contradicted area
};

/// Scores the projected points. Points behind the measured surface (occluded), without depth, or outside the image
/// count neither way.
DepthScore score_projected_view(const ProjectedView& projected, const DepthTolerance& tolerance);

/// Scores the first `points` points of the view nearest to the pose.
DepthScore score_pose(const RgbdFrame& frame, const ObjectModel& model, const Eigen::Isometry3d& T_camera_object,
                      int points, const DepthTolerance& tolerance);

/// Gives a shift of the pose along the line of sight, with the depth score after it.
struct DepthShift {
  double shift_m = 0.0;
  DepthScore score;  ///< score_pose's result there, but for the small change of scale
};

/// Limits of the search for a depth shift.
struct ShiftSearch {
  int points = 0;        ///< number of first points of the nearest view
  double reach_m = 0.0;  ///< distance to each side
  DepthTolerance tolerance;
};

/// Returns the shift within reach that makes most visible points agree; none where no point is within reach.
DepthShift best_depth_shift(const RgbdFrame& frame, const ObjectModel& model, const Eigen::Isometry3d& T_camera_object,
                            const ShiftSearch& search);

// The names of before, for one release.
using ViewLook [[deprecated("is ProjectedView now")]] = ProjectedView;
using Look [[deprecated("is ProjectedPoint now")]] = ProjectedPoint;

}  // namespace houghstream
