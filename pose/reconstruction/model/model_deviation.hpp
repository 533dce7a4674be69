#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <vector>

#include "pipeline/geometry/mesh.hpp"
#include "pose/reconstruction/tracking/take.hpp"

namespace houghstream::reconstruction {

/// Holds the mask and pose of the object in a keyframe.
struct MaskedKeyframe {
  int keyframe = 0;  ///< index in the take
  Eigen::Isometry3d T_camera_object = Eigen::Isometry3d::Identity();
  cv::Mat mask;  ///< CV_8UC1, 255 where the object is visible. Size of the frame
};

/// Views of one take, which outlive this.
struct ViewsOfTake {
  const Take* take = nullptr;
  const std::vector<MaskedKeyframe>* views = nullptr;
};

/// Returns the median distance, along the model's normals, of the depth that the takes' views measure on their masks,
/// metres; 0 where they measure none. The result is the same for any number of threads.
double surface_deviation(const Mesh& mesh, const std::vector<ViewsOfTake>& of_takes, int threads);

/// Returns the pixels of the frame in which the model is visible at this pose: neither occluded nor a free-space
/// violation.
cv::Mat render_visible_mask(const Mesh& mesh, const RgbdFrame& frame, const Eigen::Isometry3d& T_camera_object);

/// Returns the fraction of the model's rendered pixels that violate free space. A hand or a piece of the table that was
/// fused into the model violates it in all views in which it has gone.
double free_space_violation(const Mesh& mesh, const Take& take, const std::vector<MaskedKeyframe>& views, int threads);

/// Maximum for a clean model: in the takes of `hs-render takes --development`, on which settings are chosen, clean ones
/// had at most 0.004, those with a fused hand or table at least 0.06.
constexpr double kMaxFreeSpaceViolation = 0.02;

}  // namespace houghstream::reconstruction
