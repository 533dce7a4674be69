#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <vector>

#include "pipeline/types/frame.hpp"
#include "pose/model/object_model.hpp"

namespace houghstream {

/// Where a model's point falls in a frame, and what was measured there.
struct Look {
  /// Measured minus model depth along the ray, metres; NaN where nothing was measured or the image ends.
  float beyond = std::numeric_limits<float>::quiet_NaN();
  int x = 0;  ///< pixel; meaningless where the image ends
  int y = 0;
};

/// A model's view at a pose, against a frame.
struct ViewLook {
  const ModelView& view;    ///< nearest to the pose
  Eigen::Isometry3f T;      ///< camera from object
  std::vector<Look> looks;  ///< of the first points of the view
};
ViewLook look_at_view(const RgbdFrame& frame, const ObjectModel& model, const Eigen::Isometry3d& T_camera_object,
                      int points);

}  // namespace houghstream
