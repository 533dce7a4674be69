#include <gtest/gtest.h>

#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "pipeline/base/checks.hpp"
#include "pipeline/geometry/mesh.hpp"
#include "tests/expect_says.hpp"
#include "tests/test_files.hpp"

namespace houghstream {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMaterials =
    "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\nnewmtl green_picture\nmap_Kd green.png\n"
    "newmtl grey_picture\nmap_Kd grey.png\n";

/// Writes two triangles, at z = 0 and z = 1 m, of two materials; texture coordinates of the second are up to `maximum`.
fs::path write_obj(const std::string& name, const std::string& first, const std::string& second,
                   float maximum = 0.75F) {
  const fs::path folder = fs::temp_directory_path() / ("houghstream_mesh_paint_test_" + name);
  fs::remove_all(folder);
  fs::create_directories(folder);
  std::ofstream(folder / "all.mtl") << kMaterials;
  cv::imwrite((folder / "green.png").string(), cv::Mat(20, 30, CV_8UC3, cv::Scalar(0, 200, 0)));
  cv::imwrite((folder / "grey.png").string(), cv::Mat(40, 10, CV_8UC3, cv::Scalar(90, 90, 90)));
  std::ofstream(folder / "two.obj") << "mtllib all.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\n"
                                    << "vt 0.25 0.25\nvt " << maximum << " 0.25\nvt 0.25 0.75\nusemtl " << first
                                    << "\nf 1/1 2/2 3/3\nusemtl " << second << "\nf 4/1 5/2 6/3\n";
  return folder / "two.obj";
}

/// Colour that the mesh shows at a vertex.
cv::Vec3b shown(const Mesh& mesh, std::size_t vertex) {
  if (mesh.texture.empty()) return mesh.colours[vertex];
  const Eigen::Vector2f& uv = mesh.uvs[vertex];
  return mesh.texture.at<cv::Vec3b>(static_cast<int>(uv.y() * static_cast<float>(mesh.texture.rows)),
                                    static_cast<int>(uv.x() * static_cast<float>(mesh.texture.cols)));
}

/// Every vertex of the first triangle and of the second shows these.
void expect_shown(const Mesh& mesh, const cv::Vec3b& first, const cv::Vec3b& second) {
  ASSERT_EQ(mesh.vertices.size(), 6U);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    EXPECT_EQ(shown(mesh, i), mesh.vertices[i].z() < 0.5F ? first : second);
  }
}

TEST(MeshPaint, ColouredMaterialsBecomeColoursOfVertices) {
  const Mesh mesh = load_mesh(write_obj("colours", "red", "blue"), 1.0);
  EXPECT_TRUE(mesh.texture.empty());
  EXPECT_TRUE(mesh.uvs.empty());
  expect_shown(mesh, {0, 0, 255}, {255, 0, 0});
}

TEST(MeshPaint, OneTextureStaysAsItIs) {
  const Mesh mesh = load_mesh(write_obj("one", "green_picture", "green_picture"), 1.0);
  EXPECT_EQ(mesh.texture.size(), cv::Size(30, 20));
  EXPECT_NEAR(mesh.uvs[0].y(), 0.75F, 1e-5F) << "v downwards";
  expect_shown(mesh, {0, 200, 0}, {0, 200, 0});
}

TEST(MeshPaint, SeveralTexturesBecomeOne) {
  expect_shown(load_mesh(write_obj("several", "green_picture", "grey_picture"), 1.0), {0, 200, 0}, {90, 90, 90});
}

TEST(MeshPaint, TexturesAndColoursBecomeOneTexture) {
  expect_shown(load_mesh(write_obj("both", "red", "grey_picture"), 1.0), {0, 0, 255}, {90, 90, 90});
}

TEST(MeshPaint, RepeatedTexturesAreReadAloneOnly) {
  EXPECT_NO_THROW(load_mesh(write_obj("repeated", "green_picture", "green_picture", 2.5F), 1.0));
  EXPECT_THROW(load_mesh(write_obj("repeated_two", "green_picture", "grey_picture", 2.5F), 1.0), InputError);
}

TEST(MeshPaint, MissingTexturesAreNamed) {
  const fs::path file = write_obj("missing", "green_picture", "grey_picture");
  fs::remove(file.parent_path() / "grey.png");
  expect_says(error_of([&] { load_mesh(file, 1.0); }), {"grey.png"});
}

TEST(MeshPaint, ColoursOfTheVerticesThemselvesAreRead) {
  const fs::path file = write_obj("vertices", "red", "red");
  std::ofstream(file) << "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nf 1 2 3\n";
  const Mesh mesh = load_mesh(file, 1.0);
  ASSERT_EQ(mesh.colours.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    const cv::Vec3b expected = mesh.vertices[i].x() > 0.5F   ? cv::Vec3b(0, 255, 0)
                               : mesh.vertices[i].y() > 0.5F ? cv::Vec3b(255, 0, 0)
                                                             : cv::Vec3b(0, 0, 255);
    EXPECT_EQ(mesh.colours[i], expected);
  }
}

}  // namespace
}  // namespace houghstream
