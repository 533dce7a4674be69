#pragma once

#include <vector>

#include "pipeline/types/camera.hpp"
#include "tools/render/world/objects/world.hpp"

namespace houghstream::world {

/// Depth of the world seen from a light: what lies deeper is in shadow (Williams 1978).
struct ShadowMap {
  Camera camera;  ///< of the light; width 0 = no shadows
  Eigen::Isometry3d T_light_world = Eigen::Isometry3d::Identity();
  cv::Mat inverse_depth;  ///< CV_32FC1, 1/m, 0 = nothing
};

/// Of the world's first `focus_radius_m` around its origin.
ShadowMap make_shadow_map(const World& world, const Light& light);

/// Looks points up in a shadow map, from camera coordinates.
class ShadowLookup {
 public:
  ShadowLookup(const ShadowMap& map, const Eigen::Isometry3d& T_world_camera, double penumbra_m);

  /// Share of the light that arrives at a point, 0 to 1. `turn` in [0,1) turns the pattern of samples, so that
  /// penumbrae show grain instead of bands (percentage-closer filtering, Reeves et al. 1987).
  float lit(const Eigen::Vector3f& point_camera, float turn) const;

 private:
  const ShadowMap& map_;
  Eigen::Isometry3f T_light_camera_;
  float penumbra_m_;
};

}  // namespace houghstream::world
