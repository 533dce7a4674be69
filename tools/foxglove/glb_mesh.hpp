#pragma once

#include <string>

#include "pipeline/geometry/mesh.hpp"

namespace houghstream::foxglove {

/// Encodes a mesh as binary glTF 2.0, metres, with its normals and its texture (JPEG) or colours. As glTF demands, y is
/// up in it: a point (x, y, z) of the object frame is (x, z, -y), which viewers whose z is up turn back. Throws
/// InputError where the mesh has no triangle.
std::string encode_glb(const Mesh& mesh);

}  // namespace houghstream::foxglove
