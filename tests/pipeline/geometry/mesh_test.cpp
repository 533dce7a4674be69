#include "pipeline/geometry/mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "pipeline/base/checks.hpp"
#include "tests/test_files.hpp"

namespace houghstream {
namespace {

namespace fs = std::filesystem;

/// Returns a box 0.1 x 0.2 x 0.3 m around the origin; two triangles a side, counter-clockwise from outside.
Mesh box_mesh() {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.emplace_back((i & 1) != 0 ? 0.05F : -0.05F, (i & 2) != 0 ? 0.1F : -0.1F,
                               (i & 4) != 0 ? 0.15F : -0.15F);
    mesh.normals.push_back(mesh.vertices.back().normalized());
    mesh.colours.emplace_back(static_cast<std::uint8_t>(10 * i), 200, 30);
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

void write_text(const fs::path& file, const std::string& text) {
  std::ofstream(file) << text;
}

TEST(Mesh, DiameterOfABoxIsItsDiagonal) {
  EXPECT_NEAR(mesh_diameter(box_mesh()), std::sqrt(0.01 + 0.04 + 0.09), 1e-6);
}

TEST(Mesh, DiameterDoesNotDependOnWhereTheOriginIs) {
  Mesh mesh = box_mesh();
  for (Eigen::Vector3f& v : mesh.vertices) v += Eigen::Vector3f(5.0F, -3.0F, 1.0F);
  EXPECT_NEAR(mesh_diameter(mesh), std::sqrt(0.14), 1e-5);
}

TEST(Mesh, SampledPointsLieOnTheSurfaceEvenlyAndRepeat) {
  const Mesh mesh = box_mesh();
  const SurfacePoints points = sample_surface(mesh, 500, 7);
  ASSERT_EQ(points.points.size(), 500U);
  int on_largest_sides = 0;
  for (std::size_t i = 0; i < points.points.size(); ++i) {
    const Eigen::Vector3f p = points.points[i];
    const Eigen::Vector3f past = p.cwiseAbs() - Eigen::Vector3f(0.05F, 0.1F, 0.15F);
    EXPECT_NEAR(past.maxCoeff(), 0.0F, 1e-5F);
    EXPECT_GT(points.normals[i].dot(p), 0.0F) << "normals point outwards";
    on_largest_sides += std::abs(points.normals[i].x()) > 0.9F ? 1 : 0;
  }
  // The two 0.2 x 0.3 sides are 0.12 of 0.22 square metres.
  EXPECT_NEAR(on_largest_sides, 500 * 0.12 / 0.22, 40);
  EXPECT_EQ(sample_surface(mesh, 500, 7).points[499], points.points[499]);
  EXPECT_NE(sample_surface(mesh, 500, 8).points[499], points.points[499]);
}

TEST(Mesh, SamplingNeedsASurface) {
  Mesh flat = box_mesh();
  flat.triangles.clear();
  EXPECT_THROW(sample_surface(flat, 10, 1), InputError);
  EXPECT_THROW(sample_surface(box_mesh(), 0, 1), InputError);
}

TEST(MeshFile, PlyKeepsGeometryNormalsAndColours) {
  const fs::path file = fresh_folder("ply") / "box.ply";
  const Mesh mesh = box_mesh();
  save_ply(mesh, file);
  const Mesh back = load_mesh(file);
  ASSERT_EQ(back.vertices.size(), 8U);
  ASSERT_EQ(back.triangles.size(), 12U);
  ASSERT_EQ(back.colours.size(), 8U);
  EXPECT_TRUE(back.uvs.empty());
  EXPECT_TRUE(back.texture.empty());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t before = mesh.triangles[t][k];
      const std::uint32_t after = back.triangles[t][k];
      EXPECT_NEAR((back.vertices[after] - mesh.vertices[before]).norm(), 0.0F, 1e-6F);
      EXPECT_NEAR((back.normals[after] - mesh.normals[before]).norm(), 0.0F, 1e-5F);
      EXPECT_EQ(back.colours[after], mesh.colours[before]);
    }
  }
}

TEST(MeshFile, PlyWithoutColoursGetsNone) {
  const fs::path file = fresh_folder("plain") / "box.ply";
  Mesh mesh = box_mesh();
  mesh.colours.clear();
  save_ply(mesh, file);
  const Mesh back = load_mesh(file);
  EXPECT_TRUE(back.colours.empty()) << "a grey that the file does not know";
  EXPECT_TRUE(back.texture.empty());
}

TEST(MeshFile, PlyKeepsItsTexture) {
  const fs::path file = fresh_folder("texture") / "box.ply";
  Mesh mesh = box_mesh();
  mesh.colours.clear();
  for (const Eigen::Vector3f& v : mesh.vertices) mesh.uvs.emplace_back(v.x() + 0.5F, v.y() + 0.3F);
  mesh.texture = cv::Mat(4, 4, CV_8UC3, cv::Scalar(1, 2, 3));
  save_ply(mesh, file);
  const Mesh back = load_mesh(file);
  ASSERT_EQ(back.uvs.size(), back.vertices.size());
  ASSERT_EQ(back.texture.size(), cv::Size(4, 4));
  EXPECT_EQ(back.texture.at<cv::Vec3b>(3, 3), cv::Vec3b(1, 2, 3));
  const std::uint32_t corner = back.triangles[0][1];
  EXPECT_NEAR((back.uvs[corner] - mesh.uvs[2]).norm(), 0.0F, 1e-5F);
  fs::remove(fs::path(file).replace_extension(".png"));
  EXPECT_THROW(load_mesh(file), InputError) << "the named texture is gone";
}

TEST(MeshFile, ObjIsReadInItsUnitAndGetsNormals) {
  const fs::path file = fresh_folder("obj") / "triangle.obj";
  write_text(file, "v 0 0 0\nv 2 0 0\nv 0 2 0\nf 1 2 3\n");
  const Mesh mesh = load_mesh(file, 1.0);
  ASSERT_EQ(mesh.triangles.size(), 1U);
  EXPECT_NEAR(mesh_diameter(mesh), std::sqrt(8.0), 1e-5);
  ASSERT_EQ(mesh.normals.size(), 3U);
  EXPECT_NEAR(mesh.normals[0].z(), 1.0F, 1e-5F);
}

TEST(MeshFile, BadFilesAreRefused) {
  const fs::path folder = fresh_folder("bad");
  EXPECT_THROW(load_mesh(folder / "none.ply"), InputError);
  write_text(folder / "text.ply", "this is no mesh");
  EXPECT_THROW(load_mesh(folder / "text.ply"), InputError);
  write_text(folder / "empty.obj", "");
  EXPECT_THROW(load_mesh(folder / "empty.obj"), InputError);
  write_text(folder / "points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
  EXPECT_THROW(load_mesh(folder / "points.obj"), InputError);
  write_text(folder / "nan.ply",
             "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
             "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1e39 0 0\n0 1 0\n3 0 1 2\n");
  EXPECT_THROW(load_mesh(folder / "nan.ply"), InputError);
  EXPECT_THROW(save_ply(box_mesh(), folder / "no_such_folder" / "box.ply"), InputError);
}

}  // namespace
}  // namespace houghstream
