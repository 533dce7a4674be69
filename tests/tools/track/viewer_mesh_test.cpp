#include "tools/track/viewer_mesh.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "pipeline/base/checks.hpp"
#include "tests/pipeline/geometry/tetrahedron.hpp"

namespace houghstream::track {
namespace {

namespace fs = std::filesystem;

/// Red where the fourth vertex is not, darker elsewhere.
Mesh red_tetrahedron() {
  Mesh mesh = tetrahedron(0.1F);
  mesh.colours = {{0, 0, 255}, {0, 0, 255}, {0, 0, 255}, {0, 0, 0}};
  compute_normals(mesh);
  return mesh;
}

fs::path empty_folder(const std::string& name) {
  fs::path folder = fs::temp_directory_path() / ("houghstream_viewer_mesh_" + name);
  fs::remove_all(folder);
  return folder;
}

std::string text_of(const fs::path& file) {
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

TEST(ViewerMesh, IsAnObjInMetresWithItsMaterialsBesideIt) {
  const ViewerMesh written = write_viewer_mesh(red_tetrahedron(), "my mug/2", empty_folder("obj"));
  ASSERT_TRUE(fs::path(written.file).is_absolute());
  EXPECT_EQ(fs::path(written.file).extension(), ".obj");
  EXPECT_EQ(fs::path(written.file).filename().string().substr(0, 9), "my_mug_2-") << "no blanks, no folders";
  const Mesh back = load_mesh(written.file, 1.0);
  EXPECT_EQ(back.triangles.size(), 4U);
  EXPECT_NEAR(mesh_bounds(back).max().x(), 0.1F, 1e-6F);
  const std::string obj = text_of(written.file);
  const std::string mtl = fs::path(written.file).replace_extension(".mtl").filename().string();
  EXPECT_EQ(obj.substr(0, obj.find('\n')), "mtllib " + mtl);
  const std::string materials = text_of(fs::path(written.file).replace_extension(".mtl"));
  EXPECT_NE(materials.find("Kd 1.000 0.000 0.000"), std::string::npos) << materials;
  EXPECT_NE(materials.find("Kd 0.667 0.000 0.000"), std::string::npos) << materials;
  EXPECT_NEAR(written.colour[0], 0.75F, 1e-4F);
  EXPECT_EQ(written.colour[1], 0.0F);
}

TEST(ViewerMesh, ATexturesColoursAreThoseOfItsTriangles) {
  Mesh mesh = red_tetrahedron();
  mesh.colours.clear();
  mesh.uvs.assign(4, {0.9F, 0.9F});
  mesh.texture = cv::Mat(4, 4, CV_8UC3, cv::Scalar(255, 0, 0));
  EXPECT_EQ(write_viewer_mesh(mesh, "mug", empty_folder("texture")).colour, (std::array<float, 3>{0, 0, 1}));
}

TEST(ViewerMesh, EqualMeshesAreOneFileAndOthersAnother) {
  const fs::path folder = empty_folder("equal");
  const ViewerMesh first = write_viewer_mesh(red_tetrahedron(), "mug", folder);
  const auto written = fs::last_write_time(first.file);
  EXPECT_EQ(write_viewer_mesh(red_tetrahedron(), "mug", folder).file, first.file);
  EXPECT_EQ(fs::last_write_time(first.file), written) << "not written again";
  Mesh larger = red_tetrahedron();
  larger.vertices[1].x() = 0.2F;
  EXPECT_NE(write_viewer_mesh(larger, "mug", folder).file, first.file);
  Mesh darker = red_tetrahedron();
  darker.colours[1] = {0, 0, 0};
  EXPECT_NE(write_viewer_mesh(darker, "mug", folder).file, first.file);
}

TEST(ViewerMesh, AFolderThatCannotBeMadeIsNamed) {
  const fs::path file = empty_folder("file");
  std::ofstream(file) << "no folder";
  try {
    write_viewer_mesh(red_tetrahedron(), "mug", file / "meshes");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find((file / "meshes").string()), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace houghstream::track
