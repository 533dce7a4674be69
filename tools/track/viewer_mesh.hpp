#pragma once

#include <array>
#include <filesystem>
#include <string>

#include "pipeline/geometry/mesh.hpp"

namespace houghstream::track {

/// A mesh as other programs' viewers take it.
struct ViewerMesh {
  std::string file;             ///< OBJ in metres, absolute path
  std::array<float, 3> colour;  ///< red, green, blue, 0 to 1: the mean of the mesh, for viewers without its materials
};

/// Writes NAME-NUMBER.obj, and beside it the .mtl with the colours of the mesh (or of its texture, each triangle in one
/// colour), into the folder, which is made where it is missing. NUMBER is made of the mesh: equal ones are one file,
/// which is not written again, and another one never takes its place while a viewer reads it. Not PLY as models are:
/// meldis shows OBJ, glTF and DAE only. Throws InputError where it cannot write.
ViewerMesh write_viewer_mesh(const Mesh& mesh, const std::string& name, const std::filesystem::path& folder);

}  // namespace houghstream::track
