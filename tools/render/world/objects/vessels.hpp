#pragma once

#include "tools/render/world/objects/materials.hpp"
#include "tools/render/world/objects/mesh_parts.hpp"

// Meshes of vessels and cartons, finished (origin at the centre of the bounding box). Lengths in metres.

namespace houghstream::world {

struct BowlShape {
  double rim_radius = 0.075;
  double foot_radius = 0.035;
  double height = 0.06;
  double wall = 0.004;
};
Mesh bowl_mesh(const BowlShape& shape, const cv::Mat& texture);

struct MugShape {
  double rim_radius = 0.04;
  double foot_radius = 0.04;
  double height = 0.095;
  double wall = 0.004;
};
/// Makes a mug with a handle to +x.
Mesh mug_mesh(const MugShape& shape, const Palette& palette, Random& random);

/// Makes a vessel without a handle: glasses, cups, pots.
Mesh cup_mesh(const MugShape& shape, const cv::Mat& texture);

/// Drinks can: label round the side, metal ends with necks.
Mesh can_mesh(double radius, double height, const Palette& palette, Random& random);

/// Makes a printed carton.
Mesh carton_mesh(const Eigen::Vector3d& size, const Palette& palette, Random& random);

/// Makes a solid body of revolution through (radius, z) points from bottom to top, with closed ends.
Mesh rotated_mesh(const std::vector<Eigen::Vector2d>& outline, const cv::Mat& texture);

}  // namespace houghstream::world
