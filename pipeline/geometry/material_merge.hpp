#pragma once

#include <filesystem>
#include <vector>

#include "pipeline/geometry/mesh.hpp"

// Merges a file's materials into vertex colours or one texture; for mesh_io.cpp only.

namespace houghstream {

/// Holds the vertices of one material.
struct MeshPart {
  std::size_t first_vertex = 0;
  std::size_t vertices = 0;
  bool has_uvs = false;
  std::filesystem::path texture;  ///< empty = none; parts of one texture have the same path
  cv::Mat image;                  ///< texture embedded in the mesh's file, CV_8UC3 BGR; else empty
  bool has_colour = false;        ///< the material states one
  cv::Vec3b colour;               ///< BGR
};

/// Paints a mesh whose `uvs` hold one entry per vertex: one texture for all parts stays as it is; parts without texture
/// give their vertices their colours; where there are several textures, or both, they go side by side into one texture.
/// `uvs` is left empty without a texture. Colours of the vertices themselves, where all have them, win over those of
/// materials. Throws InputError where a texture is missing, or several are there and one of them is repeated (uvs
/// beyond 0 to 1).
void paint(const std::vector<MeshPart>& parts, const std::filesystem::path& file, Mesh& mesh);

}  // namespace houghstream
