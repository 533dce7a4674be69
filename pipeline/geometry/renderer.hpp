#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <vector>

#include "pipeline/base/no_value.hpp"
#include "pipeline/geometry/mesh.hpp"
#include "pipeline/types/camera.hpp"

namespace houghstream {

/// Describes one mesh placed in front of the camera. `id` is its value in the id image (1..65535).
struct RenderItem {
  const Mesh* mesh = nullptr;
  Eigen::Isometry3d T_camera_object = Eigen::Isometry3d::Identity();
  int id = 1;
};

/// Holds the nearest surface of each pixel. Shading is left to the caller.
struct RenderedGeometry {
  cv::Mat depth;     ///< CV_32FC1, metres along the optical axis, NaN = nothing
  cv::Mat id;        ///< CV_16UC1, RenderItem::id, 0 = nothing
  cv::Mat triangle;  ///< CV_32SC1, index of the triangle in its mesh, -1 = nothing
  cv::Mat bary;      ///< CV_32FC2, perspective-correct weights of the triangle's 2nd and 3rd vertex
};

/// Renders by a Z-buffer, with pixel centres at integer coordinates and the near plane at 0.05 m (triangles that cross
/// it are clipped). The same input gives the same output, bit for bit.
RenderedGeometry render_geometry(const std::vector<RenderItem>& items, const Camera& camera);

/// Renders the part of the image inside `region_px`; the result has the region's size.
RenderedGeometry render_geometry(const std::vector<RenderItem>& items, const Camera& camera, const cv::Rect& region_px);

/// Renders only depth, inside `region_px` of the image, in half the time. Returns an image of the region's size, NaN =
/// nothing.
cv::Mat render_depth(const std::vector<RenderItem>& items, const Camera& camera, const cv::Rect& region_px);

/// Renders one mesh.
cv::Mat render_depth(const Mesh& mesh, const Eigen::Isometry3d& T_camera_object, const Camera& camera,
                     const cv::Rect& region_px);

/// The part of the image that a mesh may cover, and its depth there.
struct RenderedRegion {
  cv::Rect region_px;  ///< empty where no pixel can show the mesh; the whole image where it reaches the near plane
  cv::Mat depth;       ///< depth as returned by render_depth()

  /// Returns the depth at a pixel of the image, metres; NaN beside the mesh.
  float depth_at(const cv::Point& at_px) const {
    return region_px.contains(at_px) ? depth.at<float>(at_px - region_px.tl()) : kNoValue;
  }
};

/// Finds the part itself, from the vertices that are placed to be drawn: of a dense mesh most of the work is with these
/// (pose verification's fast path).
RenderedRegion render_depth_region(const Mesh& mesh, const Eigen::Isometry3d& T_camera_object, const Camera& camera);

}  // namespace houghstream
