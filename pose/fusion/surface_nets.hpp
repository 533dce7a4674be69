#pragma once

#include <vector>

#include "pipeline/geometry/mesh.hpp"
#include "pose/fusion/tsdf_volume.hpp"

namespace houghstream::fusion {

/// Extracts the surface between inside and outside by surface nets (Gibson 1998): one vertex in each cell that the
/// surface crosses, at the mean of the crossings of the cell's edges. The mesh is closed, has normals, and its
/// triangles are counter-clockwise from outside. The border of the grid counts as outside. Vertices: object frame,
/// metres.
Mesh extract_surface(const TsdfVolume& grid);

/// Returns the connected part of a mesh with the most triangles, with the vertices it uses; for meshes with vertices
/// and triangles only.
Mesh largest_part(const Mesh& mesh);

/// Returns a closed surface without the parts of more than a square centimetre that no view has observed, such as the
/// bottom of a mug, since their position is a guess. Parts that are nowhere higher than `foot_z_m` stay: the object
/// stands on them. `seen` is per vertex.
Mesh remove_unobserved(const Mesh& mesh, const std::vector<bool>& seen, double foot_z_m);

}  // namespace houghstream::fusion
