#include "tools/foxglove/glb_mesh.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"
#include "tests/test_files.hpp"

namespace houghstream::foxglove {
namespace {

Mesh two_triangles() {
  Mesh mesh;
  mesh.vertices = {{0.0F, 0.0F, 0.0F}, {0.1F, 0.0F, 0.0F}, {0.0F, 0.2F, 0.0F}, {0.0F, 0.0F, 0.3F}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  compute_normals(mesh);
  return mesh;
}

/// Returns the mesh that our own reader, which assimp stands behind, makes of it.
Mesh read_back(const Mesh& mesh, const std::string& name) {
  const std::filesystem::path file = fresh_folder(name) / "mesh.glb";
  write_text(file, encode_glb(mesh));
  return load_mesh(file, 1.0);
}

TEST(EncodeGlb, HasTheSurfaceWithYUp) {
  const Mesh mesh = two_triangles();
  const Mesh read = read_back(mesh, "glb_surface");
  ASSERT_EQ(read.vertices.size(), 4U);
  ASSERT_EQ(read.triangles.size(), 2U);
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector3f& v = mesh.vertices[i];
    EXPECT_LT((read.vertices[i] - Eigen::Vector3f(v.x(), v.z(), -v.y())).norm(), 1e-6F) << i;
    const Eigen::Vector3f& n = mesh.normals[i];
    EXPECT_LT((read.normals[i] - Eigen::Vector3f(n.x(), n.z(), -n.y())).norm(), 1e-3F) << i;
  }
}

TEST(EncodeGlb, HasTheTexture) {
  Mesh mesh = two_triangles();
  mesh.uvs = {{0.0F, 0.0F}, {1.0F, 0.0F}, {0.0F, 1.0F}, {0.25F, 0.5F}};
  mesh.texture = cv::Mat(16, 32, CV_8UC3, cv::Scalar(20, 120, 220));
  const Mesh read = read_back(mesh, "glb_texture");
  ASSERT_EQ(read.texture.size(), cv::Size(32, 16));
  EXPECT_NEAR(read.texture.at<cv::Vec3b>(8, 8)[2], 220, 3);
  ASSERT_EQ(read.uvs.size(), 4U);
  EXPECT_LT((read.uvs[3] - mesh.uvs[3]).norm(), 1e-6F);
}

TEST(EncodeGlb, HasColoursThatAreLinearAsGltfDemands) {
  Mesh mesh = two_triangles();
  mesh.colours.assign(4, cv::Vec3b(255, 0, 188));  // BGR; 188 of sRGB is half the intensity
  const std::string glb = encode_glb(mesh);
  const Mesh read = read_back(mesh, "glb_colours");
  EXPECT_NE(glb.find("COLOR_0"), std::string::npos);
  ASSERT_EQ(read.colours.size(), 4U);
  EXPECT_EQ(read.colours[0][0], 255);
  EXPECT_EQ(read.colours[0][1], 0);
}

TEST(EncodeGlb, ADifferentMeshWithoutASurfaceIsRefused) {
  Mesh mesh = two_triangles();
  mesh.triangles.clear();
  EXPECT_EQ(error_of([&] { encode_glb(mesh); }), "mesh of 4 vertices: no triangle");
}

}  // namespace
}  // namespace houghstream::foxglove
