#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <vector>

#include "pipeline/geometry/mesh.hpp"
#include "pose/reconstruction/tracking/take.hpp"

namespace houghstream::reconstruction {

/// The object in a keyframe.
struct MaskedKeyframe {
  int keyframe = 0;  ///< of the take
  Eigen::Isometry3d T_camera_object = Eigen::Isometry3d::Identity();
  cv::Mat mask;  ///< CV_8UC1, 255 where the object is seen: nothing hides it there. Size of the frame
};

/// Views of one take, which outlive this.
struct ViewsOfTake {
  const Take* take = nullptr;
  const std::vector<MaskedKeyframe>* views = nullptr;
};

/// Median distance of all that the takes' views measure on their masks from the model, along its normals, metres; 0
/// where they measure nothing. Thread-count makes no difference.
double surface_deviation(const Mesh& mesh, const std::vector<ViewsOfTake>& of_takes, int threads);

/// Pixels of the frame in which the model is seen at this pose, and neither hidden nor seen through.
cv::Mat render_visible_mask(const Mesh& mesh, const RgbdFrame& frame, const Eigen::Isometry3d& T_camera_object);

/// Share of the model's pixels in its views behind which depth is measured. A hand or a piece of the table that was
/// taken for the object is seen through in all views in which it has gone.
double free_space_violation(const Mesh& mesh, const Take& take, const std::vector<MaskedKeyframe>& views, int threads);

/// The most that a model without such parts has: of development takes those without had up to 0.004, those with from
/// 0.06 on.
constexpr double kMaxFreeSpaceViolation = 0.02;

}  // namespace houghstream::reconstruction
