#pragma once

#include <vector>

#include "pipeline/geometry/renderer.hpp"
#include "tools/render/world/optics/shadow_map.hpp"

namespace houghstream::world {

/// A world with the shadows of its lights computed once.
struct LitWorld {
  World world;
  std::vector<ShadowMap> shadows;  ///< one per light
};
LitWorld light_world(World world);

/// What each pixel sees. Ids in `geometry` are index in World::items plus 1.
struct ShadedView {
  RenderedGeometry geometry;
  cv::Mat radiance;       ///< CV_32FC3 BGR, linear, 0 = black
  cv::Mat cos_incidence;  ///< CV_32FC1, between surface normal and viewing ray, 0 to 1; 0 where nothing is
  cv::Mat reflectance;    ///< CV_32FC1, of the surface, linear, 0 to 1
  cv::Mat gloss;          ///< CV_32FC1, Thing::gloss
};

/// Geometry, then texture (mip-mapped, bilinear), Lambert and Blinn-Phong light per pixel.
ShadedView shade_view(const LitWorld& lit_world, const Camera& camera, const Eigen::Isometry3d& T_camera_world);

/// The same inside `region_px` of the image; the result has the region's size.
ShadedView shade_view(const LitWorld& lit_world, const Camera& camera, const Eigen::Isometry3d& T_camera_world,
                      const cv::Rect& region_px);

}  // namespace houghstream::world
