#pragma once

#include <vector>

#include "pipeline/geometry/renderer.hpp"
#include "pipeline/types/camera.hpp"
#include "tools/render/world/objects/world.hpp"

namespace houghstream::world {

/// Stores the depth of the world seen from a light: deeper points are in shadow (Williams 1978).
struct ShadowMap {
  Camera camera;  ///< camera of the light; width 0 = no shadows
  Eigen::Isometry3d T_light_world = Eigen::Isometry3d::Identity();
  cv::Mat inverse_depth;  ///< CV_32FC1, 1/m, 0 = nothing
};

/// Renders the shadow map of the world within `focus_radius_m` of its origin.
ShadowMap make_shadow_map(const World& world, const Light& light);

/// Looks points up in a shadow map, from camera coordinates.
class ShadowLookup {
 public:
  ShadowLookup(const ShadowMap& map, const Eigen::Isometry3d& T_world_camera, double penumbra_m);

  /// Returns the fraction of the light that arrives at a point, 0 to 1. `angle` in [0,1) rotates the pattern of
  /// samples, so that penumbrae show grain instead of bands (percentage-closer filtering, Reeves et al. 1987).
  float lit(const Eigen::Vector3f& point_camera, float angle) const;

 private:
  const ShadowMap& map_;
  Eigen::Isometry3f T_light_camera_;
  float penumbra_m_;
};

/// Holds a world with the shadows of its lights, which are computed once.
struct LitWorld {
  World world;
  std::vector<ShadowMap> shadows;  ///< one per light
};
LitWorld light_world(World world);

/// Holds geometry and radiance of each pixel. Ids in `geometry` are the index in World::items plus 1.
struct ShadedView {
  RenderedGeometry geometry;
  cv::Mat radiance;       ///< CV_32FC3 BGR, linear, 0 = black
  cv::Mat cos_incidence;  ///< CV_32FC1, between surface normal and viewing ray, 0 to 1; 0 where nothing is
  cv::Mat reflectance;    ///< CV_32FC1, of the surface, linear, 0 to 1
  cv::Mat specular;       ///< CV_32FC1, Asset::specular
};

/// Renders geometry, then texture (mip-mapped, bilinear), Lambert and Blinn-Phong light per pixel.
ShadedView shade_view(const LitWorld& lit_world, const Camera& camera, const Eigen::Isometry3d& T_camera_world);

/// Shades the part of the image inside `region_px`; the result has the region's size.
ShadedView shade_view(const LitWorld& lit_world, const Camera& camera, const Eigen::Isometry3d& T_camera_world,
                      const cv::Rect& region_px);

}  // namespace houghstream::world
