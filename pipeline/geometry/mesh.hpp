#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <filesystem>
#include <opencv2/core.hpp>
#include <vector>

namespace houghstream {

/// Stores a triangle mesh in its object frame, metres. `normals`, `colours` and `uvs` are empty or per vertex.
struct Mesh {
  std::vector<Eigen::Vector3f> vertices;                ///< metres
  std::vector<Eigen::Vector3f> normals;                 ///< unit length, outwards
  std::vector<cv::Vec3b> colours;                       ///< BGR
  std::vector<Eigen::Vector2f> uvs;                     ///< texture coordinates in [0,1], v down
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise seen from outside
  cv::Mat texture;                                      ///< CV_8UC3 BGR, or empty
};

/// Returns the extent of the vertices along each axis, metres.
Eigen::AlignedBox3f mesh_bounds(const Mesh& mesh);

/// Returns the largest distance between two vertices, metres (BOP's diameter); it is exact on the convex extremes.
double mesh_diameter(const Mesh& mesh);

/// Computes area-weighted vertex normals from the triangles.
void compute_normals(Mesh& mesh);

/// Takes texture and colours from it.
void remove_colour(Mesh& mesh);

/// Holds evenly spread points on the surface with normals, deterministic for a seed.
struct SurfacePoints {
  std::vector<Eigen::Vector3f> points;   ///< object frame, metres
  std::vector<Eigen::Vector3f> normals;  ///< unit length
};
SurfacePoints sample_surface(const Mesh& mesh, int count, std::uint64_t seed);

/// Reads PLY, OBJ, STL or glTF (GLB) with texture or colours; normals are made where there are none. Several textures
/// of a file, or textures and coloured materials, become one texture; colours of its materials alone become those of
/// the vertices. Textures may lie within a GLB. Axes stay as the file has them (glTF: y up). `unit_m` is the length of
/// the file's unit in metres (BOP files are in millimetres: 1e-3). Throws InputError when it is missing, unreadable,
/// empty or holds non-finite coordinates.
Mesh load_mesh(const std::filesystem::path& file, double unit_m = 1e-3);

/// Writes an ASCII PLY in millimetres with normals and vertex colours, as BOP models are. A texture goes beside it
/// as NAME.png, named in a "comment TextureFile" line. Throws InputError where it cannot write.
void save_ply(const Mesh& mesh, const std::filesystem::path& file);

}  // namespace houghstream
