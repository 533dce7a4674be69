#pragma once

#include <Eigen/Geometry>

#include "pipeline/geometry/mesh.hpp"

namespace houghstream {

/// What of a mesh lies on the plane's positive side (signed distance 0 or above, the mesh's frame and unit): triangles
/// with all three corners there, and the vertices that they use, with their normals, colours and texture coordinates.
/// The edge follows the triangles; nothing is cut. A mesh that lies below as a whole becomes an empty one.
Mesh crop_below(const Mesh& mesh, const Eigen::Hyperplane<float, 3>& plane);

/// The mesh's shape with vertices of one place made one, so that triangles that touch are connected: files give a
/// vertex of its own to each triangle corner where texture coordinates differ. Normals are made anew; no colours, no
/// texture.
Mesh welded(const Mesh& mesh);

/// The height (z, metres) on which a standing mesh rests: its lowest vertices, but for a few strays. Throws InputError
/// for a mesh without vertices.
double base_height(const Mesh& mesh);

}  // namespace houghstream
