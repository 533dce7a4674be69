#pragma once

#include "pipeline/geometry/mesh.hpp"

namespace houghstream::fusion {

/// Removes the camera's noise from a fused surface: normals are averaged with those of neighbours with similar normals,
/// so that edges stay, and vertices follow them (bilateral normal filtering, Zheng, Fu, Au and Tai 2011, on vertices).
/// It needs a mesh whose triangles share vertices, such as extract_surface() returns, with normals. Any number of
/// threads gives the same result.
void smooth_surface(int threads, Mesh& mesh);

}  // namespace houghstream::fusion
