#pragma once

#include <Eigen/Geometry>

#include "pipeline/geometry/mesh.hpp"
#include "tools/studies/recorded/mesh_alignment.hpp"

namespace houghstream {

/// Returns the part of a mesh on the plane's positive side (signed distance 0 or above, the mesh's frame and unit):
/// triangles with all three corners there, and the vertices that they use, with their normals, colours and texture
/// coordinates. The edge follows the triangles; nothing is cut. A mesh that lies below as a whole becomes an empty one.
Mesh crop_below(const Mesh& mesh, const Eigen::Hyperplane<float, 3>& plane);

/// Returns the mesh's shape with vertices of one position merged, so that triangles that touch are connected: files
/// have a separate vertex for each triangle corner where texture coordinates differ. Normals are computed again; there
/// are no colours and no texture.
Mesh welded(const Mesh& mesh);

/// Returns the height (z, metres) on which a standing mesh rests: its lowest vertices, except for a few strays. Throws
/// InputError for a mesh without vertices.
double base_height(const Mesh& mesh);

/// A scanned mesh made a model of the training views.
struct ScanModel {
  Mesh mesh;                ///< object frame of the views, metres; without the base's disc, in the views' colours
  MeshAlignment alignment;  ///< T_target_source maps the scan's frame to that of the views
};

/// The scan's frame is its scanner's; that of the views has z up and its origin on the turntable's axis. The scan is
/// registered to `fused`, the model made of the views, what lies less than `base_m` metres above its base is dropped
/// (scanned ground, not object), as are specks, and it is registered once more. Its colours are those of `fused` at the
/// nearest points, where that has any. Throws InputError for meshes without surface, or where nothing is left.
ScanModel fit_scan(const Mesh& scan, const Mesh& fused, double base_m);

}  // namespace houghstream
