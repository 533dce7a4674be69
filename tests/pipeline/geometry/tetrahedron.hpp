#pragma once

#include "pipeline/geometry/mesh.hpp"

namespace houghstream {

/// Returns a tetrahedron with corners at the origin and `side_m` along each axis.
inline Mesh tetrahedron(float side_m) {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {side_m, 0, 0}, {0, side_m, 0}, {0, 0, side_m}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return mesh;
}

}  // namespace houghstream
