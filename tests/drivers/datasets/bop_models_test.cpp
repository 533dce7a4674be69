#include <gtest/gtest.h>

#include "drivers/datasets/bop_dataset.hpp"
#include "drivers/datasets/bop_writer.hpp"
#include "pipeline/base/checks.hpp"
#include "tests/expect_says.hpp"
#include "tests/pipeline/geometry/tetrahedron.hpp"
#include "tests/test_files.hpp"

namespace houghstream {
namespace {

namespace fs = std::filesystem;

Symmetries some_symmetries() {
  Symmetries out;
  out.discrete.emplace_back(Eigen::Translation3d(0.02, 0.0, 0.0) * Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitY()));
  out.continuous = {{Eigen::Vector3d(0.0, 0.6, 0.8), Eigen::Vector3d(0.0, 0.01, 0.0)}};
  return out;
}

fs::path write_models(const std::string& name) {
  fs::path folder = fresh_folder(name);
  write_bop_models({{1, "bowl", tetrahedron(0.1F), some_symmetries()}, {12, "mug", tetrahedron(0.1F), {}}},
                   folder / "models");
  return folder;
}

TEST(BopModels, WhatIsWrittenIsReadBack) {
  const BopModels models = read_bop_models(write_models("models") / "models");
  EXPECT_EQ(models.names, (std::map<int, std::string>{{1, "bowl"}, {12, "mug"}}));
  EXPECT_NEAR(models.diameters.at(12), 0.1 * std::sqrt(2.0), 1e-6);
  EXPECT_TRUE(models.bounds.at(12).isApprox(
      Eigen::AlignedBox3d(Eigen::Vector3d::Zero(), Eigen::Vector3d::Constant(0.1)), 1e-6));
  const Symmetries& read = models.symmetries.at(1);
  ASSERT_EQ(read.discrete.size(), 1U);
  EXPECT_TRUE(read.discrete[0].isApprox(some_symmetries().discrete[0], 1e-9));
  ASSERT_EQ(read.continuous.size(), 1U);
  EXPECT_TRUE(read.continuous[0].axis.isApprox(some_symmetries().continuous[0].axis));
  EXPECT_TRUE(read.continuous[0].offset.isApprox(some_symmetries().continuous[0].offset));
  EXPECT_TRUE(models.symmetries.at(12).empty());
  EXPECT_EQ(load_mesh(models.mesh_file(12)).triangles.size(), 4U);
}

TEST(BopModels, MeshesComeByClassNameAndNamesMustDiffer) {
  const fs::path folder = write_models("models_by_class") / "models";
  const std::map<std::string, Mesh> meshes = load_class_models(folder);
  ASSERT_EQ(meshes.size(), 2U);
  EXPECT_EQ(meshes.at("mug").triangles.size(), 4U);
  write_bop_names({{1, "mug"}, {12, "mug"}}, folder / "names.json");
  EXPECT_THROW(load_class_models(folder), InputError);
}

TEST(BopModels, OfOtherFoldersEachFileIsAClass) {
  const fs::path folder = fresh_folder("models_plain");
  EXPECT_THROW(load_class_models(folder), InputError) << "empty";
  save_ply(tetrahedron(0.1F), folder / "mug.ply");
  write_text(folder / "plate.obj", "v 0 0 0\nv 200 0 0\nv 0 200 0\nf 1 2 3\n");
  std::map<std::string, Mesh> meshes = load_class_models(folder);
  ASSERT_EQ(meshes.size(), 2U);
  EXPECT_NEAR(mesh_diameter(meshes.at("mug")), 0.1 * std::sqrt(2.0), 1e-6);
  EXPECT_NEAR(mesh_diameter(meshes.at("plate")), 0.2 * std::sqrt(2.0), 1e-6);
  EXPECT_NEAR(mesh_diameter(load_class_models(folder, 1e-2).at("plate")), 2.0 * std::sqrt(2.0), 1e-5);
  write_text(folder / "mug.obj", "v 0 0 0\nv 200 0 0\nv 0 200 0\nf 1 2 3\n");
  EXPECT_THROW(load_class_models(folder), InputError) << "two of one name";
  EXPECT_THROW(load_class_models(folder / "none"), InputError);
}

TEST(BopModels, WithoutNamesObjectsAreNumbered) {
  const fs::path folder = write_models("models_unnamed") / "models";
  fs::remove(folder / "names.json");
  EXPECT_EQ(read_bop_models(folder).names.at(12), "object_12");
}

TEST(BopModels, AreFoundAboveASceneAndItsOwnNamesComeFirst) {
  const fs::path folder = write_models("models_above");
  const fs::path scene = folder / "test" / "000001";
  fs::create_directories(scene);
  ASSERT_TRUE(find_bop_models(scene).has_value());
  EXPECT_EQ(find_bop_names(scene).at(1), "bowl");
  EXPECT_EQ(find_bop_names(fs::path(scene.string() + "/")).at(1), "bowl");
  write_bop_names({{1, "cup"}}, scene / "names.json");
  EXPECT_EQ(find_bop_names(scene).at(1), "cup");
  EXPECT_TRUE(find_bop_names(fresh_folder("models_none")).empty());
}

TEST(BopModels, TheFolderAboveIsToldWithTheModelsInIt) {
  const fs::path above = write_models("models_above");
  expect_says(error_of([&] { load_class_models(above); }), {"did you mean " + (above / "models").string() + "?"});
  expect_says(error_of([&] { load_class_models(above / "models/models_info.json"); }),
              {"models_info.json: is a file, expected a folder: models"});
}

TEST(BopModels, BadFilesAreRefused) {
  EXPECT_THROW(read_bop_models(fresh_folder("models_missing")), InputError);
  const fs::path folder = write_models("models_bad") / "models";
  const std::string info = read_text(folder / "models_info.json");
  replace_in_file(folder / "models_info.json", "\"diameter\": ", "\"diameter\": -");
  EXPECT_THROW(read_bop_models(folder), InputError);
  write_text(folder / "models_info.json", info);
  replace_in_file(folder / "models_info.json", "\"size_y\": ", "\"size_y\": -");
  EXPECT_THROW(read_bop_models(folder), InputError);
  write_text(folder / "models_info.json", info.substr(0, info.size() / 2));
  EXPECT_THROW(read_bop_models(folder), InputError) << "cut short";
  write_text(folder / "models_info.json", info);
  EXPECT_NO_THROW(read_bop_models(folder));
  write_text(folder / "names.json", R"({"1": 5})");
  EXPECT_THROW(read_bop_models(folder), InputError);
  EXPECT_THROW(write_bop_models({{1, "empty", Mesh(), {}}}, folder), InputError);
}

}  // namespace
}  // namespace houghstream
