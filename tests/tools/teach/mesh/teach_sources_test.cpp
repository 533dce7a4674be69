#include "tools/teach/mesh/teach_sources.hpp"

#include <gtest/gtest.h>

#include "drivers/datasets/bop_writer.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "tests/expect_says.hpp"
#include "tests/test_files.hpp"
#include "tests/tools/teach/shapes.hpp"
#include "tools/teach/mesh/mesh_checks.hpp"

namespace houghstream::teach {
namespace {

namespace fs = std::filesystem;

/// Returns the error when the sources are refused; empty where they are not.
std::string refusal(const MeshSources& sources) {
  return error_of([&] { read_meshes(sources); });
}

MeshSources from(const fs::path& source) {
  MeshSources sources;
  sources.sources = {source.string()};
  return sources;
}

/// Returns the log of the call.
std::string warnings_of(const std::function<void()>& work) {
  start_log("teach_tests", LogLevel::kInfo);
  testing::internal::CaptureStderr();
  work();
  return testing::internal::GetCapturedStderr();
}

fs::path bop_folder(const std::string& name, const Symmetries& symmetries = {}) {
  fs::path folder = fresh_folder(name) / "models";
  write_bop_models({{2, "a", crooked_part(), symmetries}, {5, "b", crooked_part(0.2F), {}}}, folder);
  fs::remove(folder / "names.json");
  return folder;
}

TEST(MeshSources, ABopFolderIsReadAsPublished) {
  MeshSources sources = from(bop_folder("sources_bop"));
  sources.names = {"5=mustard"};
  const std::vector<TaughtMesh> meshes = read_meshes(sources);
  ASSERT_EQ(meshes.size(), 2U);
  EXPECT_EQ(meshes[0].name, "object_2");
  EXPECT_EQ(meshes[1].name, "mustard");
  EXPECT_EQ(meshes[1].id, 5);
  EXPECT_TRUE(meshes[1].coloured);
  sources.ids = {"5"};
  EXPECT_EQ(read_meshes(sources).size(), 1U);
  sources.ids = {"7"};
  expect_says(refusal(sources), {"--ids 7", "models_info.json", "no such object"});
  sources.ids = {"2"};
  expect_says(refusal(sources), {"--names '5=mustard'", "no object '5' is read"});
  sources.ids = {"5", "05"};
  expect_says(refusal(sources), {"--ids 05", "expected each id once"});
  sources.ids = {"5"};
  sources.names = {"5=mustard", "5=ketchup"};
  expect_says(refusal(sources), {"--names '5=ketchup'", "'5' has another new name already"});
}

TEST(MeshSources, FilesHaveTheirNamesAndUnits) {
  const fs::path folder = fresh_folder("sources_files");
  save_ply(crooked_part(), folder / "bracket.ply");
  write_text(folder / "plate.obj", "v 0 0 0\nv 0.2 0 0\nv 0 0.2 0\nv 0 0 0.1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  MeshSources both = from(folder);
  expect_says(refusal(both), {"plate.obj", "read in mm", "expected 0.01 to 1.5 m", "--unit m would make it 0.283 m"});
  both.sources = {(folder / "bracket.ply").string()};
  EXPECT_EQ(read_meshes(both).at(0).name, "bracket");
  both.unit_m = 1.0;
  expect_says(refusal(both), {"bracket.ply", "m across when read in m", "--unit mm would make it"});
  both.sources = {(folder / "plate.obj").string()};
  const std::vector<TaughtMesh> plate = read_meshes(both);
  EXPECT_FALSE(plate.at(0).coloured);
  EXPECT_TRUE(plate.at(0).mesh.colours.empty());
  expect_says(refusal(from(folder / "none.ply")), {"none.ply", "no such file"});
  write_text(folder / "notes.txt", "");
  expect_says(refusal(from(folder / "notes.txt")), {"notes.txt", "expected a mesh: PLY, OBJ, STL, GLB or glTF"});
}

TEST(MeshSources, AFormatThatIsNotReadIsToldWithItsConversion) {
  const fs::path folder = fresh_folder("sources_formats");
  write_text(folder / "part.dae", "<COLLADA>");
  write_text(folder / "part.txt", "part");
  const std::string part = (folder / "part").string();
  expect_says(refusal(from(folder / "part.dae")),
              {"expected a mesh: PLY", "assimp export " + part + ".dae " + part + ".ply"});
  EXPECT_EQ(refusal(from(folder / "part.txt")).find("assimp"), std::string::npos);
}

TEST(MeshSources, AnStlHasNoUnitAndNoColour) {
  const fs::path folder = fresh_folder("sources_stl");
  std::string text = "solid part\n";
  const char* corners[] = {"0 0 0", "200 0 0", "0 150 0", "0 0 100"};
  for (const auto& [a, b, c] : {std::array{0, 2, 1}, std::array{0, 1, 3}, std::array{0, 3, 2}, std::array{1, 2, 3}}) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const int corner : {a, b, c}) text += fmt::format("vertex {}\n", corners[corner]);
    text += "endloop\nendfacet\n";
  }
  write_text(folder / "part.stl", text + "endsolid part\n");
  const std::vector<TaughtMesh> part = read_meshes(from(folder));
  ASSERT_EQ(part.size(), 1U);
  EXPECT_EQ(part[0].name, "part");
  EXPECT_FALSE(part[0].coloured);
  EXPECT_NEAR(mesh_bounds(part[0].mesh).sizes().x(), 0.2F, 1e-6F) << "millimetres, unless --unit says otherwise";
  MeshSources metres = from(folder);
  metres.unit_m = 1.0;
  expect_says(refusal(metres), {"part.stl", "when read in m", "--unit mm would make it"});
}

TEST(MeshSources, WhatNoStoreCanHoldIsRefused) {
  const fs::path folder = fresh_folder("sources_unstorable");
  Mesh far = crooked_part();
  for (Eigen::Vector3f& vertex : far.vertices) vertex += Eigen::Vector3f(0.0F, 12.0F, 0.0F);
  save_ply(far, folder / "far.ply");
  expect_says(refusal(from(folder / "far.ply")), {"far.ply", "12 m from the origin", "expected less than 10 m"});
  save_ply(crooked_part(), folder / "m\xfcg.ply");
  MeshSources sources = from(folder / "m\xfcg.ply");
  expect_says(refusal(sources), {"the name 'm\\xfcg' is not UTF-8"});
  sources.names = {"m\xfcg=t\xf6pf"};
  expect_says(refusal(sources), {"the name 't\\xf6pf' is not UTF-8"});
  for (const std::string none : {" ", "a b/c", "x,y", ".x"}) {
    sources.names = {"m\xfcg=" + none};
    expect_says(refusal(sources), {"(--names): the name '" + none + "', expected a word"});
  }
  save_ply(crooked_part(), folder / "my mug.ply");
  expect_says(refusal(from(folder / "my mug.ply")), {"(--names 'my mug=my_mug'): the name 'my mug', expected a word"});
  sources.names = {"m\xfcg=mug"};
  EXPECT_EQ(read_meshes(sources).at(0).name, "mug");
}

TEST(MeshSources, TwoObjectsOfOneNameAreRefused) {
  const fs::path folder = fresh_folder("sources_twice");
  fs::create_directories(folder / "other");
  save_ply(crooked_part(), folder / "bracket.ply");
  save_ply(crooked_part(0.2F), folder / "other" / "bracket.ply");
  MeshSources sources = from(folder);
  sources.sources.push_back((folder / "other").string());
  expect_says(refusal(sources), {"other/bracket.ply", "'bracket'", "expected one object of each name"});
}

TEST(MeshSources, WhatIsNoSurfaceIsRefused) {
  const fs::path folder = fresh_folder("sources_bad");
  write_text(folder / "points.obj", "v 0 0 0\nv 100 0 0\nv 0 100 0\n");
  expect_says(refusal(from(folder / "points.obj")), {"points.obj", "expected"});
  write_text(folder / "nan.ply",
             "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
             "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1e39 0 0\n0 100 0\n3 0 1 2\n");
  expect_says(refusal(from(folder / "nan.ply")), {"nan.ply", "vertex 1", "expected finite coordinates"});
  save_ply(crooked_part(2.0F), folder / "wardrobe.ply");
  expect_says(refusal(from(folder / "wardrobe.ply")), {"wardrobe.ply", "expected 0.01 to 1.5 m"});
  EXPECT_EQ(refusal(from(folder / "wardrobe.ply")).find("--unit"), std::string::npos) << "no unit would help";
}

TEST(MeshSources, AMissingTextureAndMissingMaterialsAreRefused) {
  const fs::path folder = fresh_folder("sources_texture");
  Mesh mesh = crooked_part();
  mesh.colours.clear();
  for (const Eigen::Vector3f& v : mesh.vertices) mesh.uvs.emplace_back(v.x() * 5.0F + 0.5F, v.y() * 5.0F + 0.5F);
  mesh.texture = cv::Mat(8, 8, CV_8UC3, cv::Scalar(10, 20, 200));
  save_ply(mesh, folder / "box.ply");
  EXPECT_TRUE(read_meshes(from(folder / "box.ply")).at(0).coloured) << "one colour, but no grey";
  fs::remove(folder / "box.png");
  expect_says(refusal(from(folder / "box.ply")), {"box.png", "missing or unreadable", "box.ply"});
  write_text(folder / "plate.obj", "mtllib paint.mtl\nv 0 0 0\nv 200 0 0\nv 0 200 0\nf 1 2 3\n");
  expect_says(refusal(from(folder / "plate.obj")), {"paint.mtl", "missing", "plate.obj"});
}

TEST(MeshSources, SymmetriesAndSizesThatContradictTheMeshAreRefused) {
  Symmetries half_turn;
  half_turn.discrete.emplace_back(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitZ()));
  expect_says(refusal(from(bop_folder("sources_symmetry", half_turn))),
              {"models_info.json object 2", "symmetries_discrete 0", "off its surface", "expected at most 15.4 mm"});
  Symmetries round;
  round.continuous = {{Eigen::Vector3d::UnitZ(), Eigen::Vector3d::Zero()}};
  expect_says(refusal(from(bop_folder("sources_round", round))), {"symmetries_continuous 0"});
  const fs::path folder = bop_folder("sources_bounds");
  replace_in_file(folder / "models_info.json", "\"size_x\": 100", "\"size_x\": 90");
  expect_says(refusal(from(folder)), {"obj_000002.ply", "expected the bounds that models_info.json states"});
}

TEST(MeshChecks, ASymmetryOfTheMeshIsAccepted) {
  Mesh brick;
  append_box({-0.05F, -0.05F, 0.0F}, {0.05F, 0.05F, 0.06F}, {40, 40, 200}, brick);
  Symmetries quarter_turn;
  quarter_turn.discrete.emplace_back(Eigen::AngleAxisd(0.5 * M_PI, Eigen::Vector3d::UnitZ()));
  EXPECT_EQ(error_of([&] { check_symmetries("brick", brick, quarter_turn); }), "");
}

TEST(MeshChecks, WhatFacesInwardsIsTurnedAround) {
  const Mesh good = crooked_part();
  Mesh inwards = good;
  for (auto& triangle : inwards.triangles) std::swap(triangle[1], triangle[2]);
  compute_normals(inwards);
  const std::string said = warnings_of([&] { check_mesh("part.ply", 1.0, inwards); });
  EXPECT_NE(said.find("part.ply: the surface faces inwards"), std::string::npos) << said;
  EXPECT_NE(said.find("expected outwards: turned around"), std::string::npos) << said;
  EXPECT_EQ(inwards.triangles, good.triangles);
  for (std::size_t i = 0; i < good.normals.size(); ++i)
    EXPECT_TRUE(inwards.normals[i].isApprox(good.normals[i], 1e-5F)) << i;
  Mesh normals = good;
  for (Eigen::Vector3f& normal : normals.normals) normal = -normal;
  warnings_of([&] { check_mesh("part.ply", 1.0, normals); });
  EXPECT_EQ(normals.triangles, good.triangles);
  EXPECT_TRUE(normals.normals[0].isApprox(good.normals[0]));
}

TEST(MeshChecks, AnOpenSurfaceIsTaughtWithALine) {
  Mesh closed = crooked_part();
  EXPECT_EQ(warnings_of([&] { check_mesh("part.ply", 1.0, closed); }), "");
  Mesh open = crooked_part();
  open.triangles.erase(open.triangles.begin(), open.triangles.begin() + 2);  // its bottom
  const std::string said = warnings_of([&] { check_mesh("part.ply", 1.0, open); });
  EXPECT_NE(said.find("part.ply: open edges of 0.32 m in all, expected a closed surface"), std::string::npos) << said;
  Mesh mixed = crooked_part();
  std::swap(mixed.triangles[0][1], mixed.triangles[0][2]);
  const std::string against = warnings_of([&] { check_mesh("part.ply", 1.0, mixed); });
  EXPECT_NE(against.find("3 of 36 neighbouring faces are wound against each other"), std::string::npos) << against;
}

TEST(MeshChecks, GreyAloneIsNoColour) {
  Mesh mesh = crooked_part();
  EXPECT_TRUE(has_colour(mesh));
  mesh.colours.assign(mesh.vertices.size(), cv::Vec3b(180, 182, 180));
  EXPECT_FALSE(has_colour(mesh));
  mesh.colours.assign(mesh.vertices.size(), cv::Vec3b(20, 30, 200));
  EXPECT_TRUE(has_colour(mesh)) << "red plastic";
  remove_colour(mesh);
  EXPECT_FALSE(has_colour(mesh));
}

}  // namespace
}  // namespace houghstream::teach
