#pragma once

#include <array>
#include <cstdint>

#include "pipeline/geometry/mesh.hpp"

namespace houghstream {

/// LabColour is a colour in 8-bit CIE L*a*b*.
using LabColour = std::array<std::uint8_t, 3>;

/// Returns the texture's pixel at texture coordinates in [0,1], v down.
const cv::Vec3b& texel_at(const cv::Mat& texture, const Eigen::Vector2f& uv);

/// Reads a mesh's colours at the resolution of a camera: finer texture is averaged, as a camera does.
class SurfaceColour {
 public:
  /// Detail smaller than `detail_m` is averaged. The mesh must outlive this object.
  SurfaceColour(const Mesh& mesh, double detail_m);

  /// Returns whether the mesh has a texture or vertex colours.
  bool has_colour() const;

  /// Returns the colour at a point of a triangle; `bary` holds the weights of its second and third vertex.
  LabColour at(std::size_t triangle, const cv::Vec2f& bary) const;

 private:
  const Mesh& mesh_;
  cv::Mat texture_;  // CV_8UC3 L*a*b*, smoothed
};

}  // namespace houghstream
