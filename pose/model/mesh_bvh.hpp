#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "pipeline/geometry/mesh.hpp"

namespace houghstream {

/// The point of a surface that is nearest to another point.
struct ClosestPoint {
  float distance = 0.0F;  ///< metres
  std::uint32_t triangle = 0;
  std::array<float, 3> weights = {1.0F, 0.0F, 0.0F};  ///< barycentric, of the triangle's vertices
};

/// Computes exact distances to a mesh. Its triangles lie in a tree of boxes, each halved at the median of its longest
/// side.
class MeshBvh {
 public:
  /// Keeps a reference to `mesh`. Throws InputError for a mesh without triangles.
  explicit MeshBvh(const Mesh& mesh);

  /// Returns the nearest point. Where no triangle is nearer than `max_distance`, metres, the result has this distance
  /// and no triangle.
  ClosestPoint nearest(const Eigen::Vector3f& point, float max_distance = std::numeric_limits<float>::infinity()) const;

  /// Returns the same, in less time where the triangle `guess` is about as near as the nearest one: the nearest of a
  /// point that has moved a little.
  ClosestPoint nearest_with_guess(const Eigen::Vector3f& point, std::uint32_t guess) const;

 private:
  struct Node {
    Eigen::AlignedBox3f box;
    std::uint32_t first = 0;  ///< index into order_
    std::uint32_t count = 0;  ///< triangles of a leaf; 0 for an inner node, whose children are below and `right`
    std::uint32_t right = 0;
  };
  using Corners = std::array<Eigen::Vector3f, 3>;

  std::uint32_t build(std::uint32_t first, std::uint32_t count);
  void search(std::uint32_t node, float node_distance, const Eigen::Vector3f& point, ClosestPoint& best) const;
  Corners corners_of(std::uint32_t triangle) const;

  const Mesh& mesh_;
  std::vector<std::uint32_t> order_;
  std::vector<Corners> corners_;  ///< corners of the triangles, in the order of `order_`
  std::vector<Node> nodes_;
};

}  // namespace houghstream
