#pragma once

#include "pipeline/geometry/mesh.hpp"

namespace houghstream::fusion {

/// Takes the camera's noise out of a fused surface: normals are averaged with those of neighbours that face alike, so
/// that edges stay, and vertices follow them (bilateral normal filtering, Zheng, Fu, Au and Tai 2011, on vertices).
/// Needs a mesh whose triangles share vertices, as extract_surface() gives, with normals. Any number of threads
/// gives the same result.
void smooth_surface(int threads, Mesh& mesh);

}  // namespace houghstream::fusion
