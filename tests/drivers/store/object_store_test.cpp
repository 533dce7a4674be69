#include "drivers/store/object_store.hpp"

#include <gtest/gtest.h>

#include "drivers/datasets/bop_writer.hpp"
#include "drivers/store/store_build.hpp"
#include "pipeline/base/checks.hpp"
#include "tests/drivers/test_files.hpp"

namespace houghstream::store {
namespace {

namespace fs = std::filesystem;

/// A tetrahedron with corners at the origin and `side_m` along each axis.
Mesh tetrahedron(float side_m) {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {side_m, 0, 0}, {0, side_m, 0}, {0, 0, side_m}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return mesh;
}

void fill(const fs::path& folder, const std::string& second_name) {
  ObjectStore store;
  store.folder = folder;
  store.objects = {{2, "mug", "cad/mug.ply", true, 12, "resting", nullptr},
                   {5, second_name, "cad/b.ply", false, 34, "any", {{"least", 0.5}}}};
  store.settings = {{"seed", 1}};
  Symmetries half_turn;
  half_turn.discrete.emplace_back(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitZ()));
  write_bop_models({{2, "mug", tetrahedron(0.1F), half_turn}, {5, second_name, tetrahedron(0.2F), {}}},
                   store.models_folder());
  write_text(store.forest_file(), "a forest");
  write_store_json(store);
}

/// A whole store of a mug and a brick.
fs::path whole_store(const std::string& name) {
  fs::path folder = fresh_folder(name) / "store";
  fs::create_directories(folder);
  fill(folder, "brick");
  return folder;
}

std::string error_of_reading(const fs::path& folder) {
  return error_of([&] { read_store(folder); });
}

std::string error_of_loading(const fs::path& folder) {
  return error_of([&] { load_store_meshes(read_store(folder)); });
}

void expect_says(const std::string& error, const std::vector<std::string>& parts) {
  for (const std::string& part : parts) EXPECT_NE(error.find(part), std::string::npos) << part << " in: " << error;
  EXPECT_EQ(error.find('\n'), std::string::npos) << error;
}

TEST(ObjectStore, WhatIsWrittenIsReadBack) {
  const ObjectStore store = read_store(whole_store("store_read"));
  ASSERT_EQ(store.objects.size(), 2U);
  EXPECT_EQ(store.objects[0].name, "mug");
  EXPECT_EQ(store.objects[0].mesh, "cad/mug.ply");
  EXPECT_TRUE(store.objects[0].coloured);
  EXPECT_EQ(store.objects[1].id, 5);
  EXPECT_EQ(store.objects[1].views, 34);
  EXPECT_EQ(store.objects[1].attitudes, "any");
  EXPECT_FALSE(store.objects[1].coloured);
  EXPECT_EQ(store.quality().size(), 1U);
  EXPECT_EQ(store.quality().at("brick").at("least"), 0.5);
  EXPECT_EQ(store.settings.at("seed"), 1);
  EXPECT_EQ(store.symmetries.at(2).discrete.size(), 1U);
  const std::map<std::string, Mesh> meshes = load_store_meshes(store);
  EXPECT_NEAR(mesh_bounds(meshes.at("brick")).sizes().x(), 0.2F, 1e-6F);
}

TEST(ObjectStore, AHalfWrittenOneIsRefused) {
  expect_says(error_of_reading("/no/such/store"), {"/no/such/store", "expected an object store"});
  for (const std::string file :
       {"store.json", "forest", "models/models_info.json", "models/names.json", "models/obj_000005.ply"}) {
    const fs::path folder = whole_store("store_half");
    fs::remove(folder / file);
    expect_says(error_of_reading(folder), {(folder / file).string(), "missing", "half written"});
  }
  const fs::path folder = whole_store("store_cut");
  const std::string text = read_text(folder / "store.json");
  write_text(folder / "store.json", text.substr(0, text.size() / 2));
  expect_says(error_of_reading(folder), {"store.json", "cut short"});
}

TEST(ObjectStore, AnotherVersionIsRefused) {
  const fs::path folder = whole_store("store_version");
  replace_in_file(folder / "store.json", "\"houghstream_store\": 1", "\"houghstream_store\": 7");
  expect_says(error_of_reading(folder), {"store.json", "version 7", "expected 1"});
}

TEST(ObjectStore, PartsThatContradictOneAnotherAreRefused) {
  const fs::path names = whole_store("store_names");
  replace_in_file(names / "models" / "names.json", "brick", "stone");
  expect_says(error_of_reading(names), {"names.json", "'stone'", "expected 'brick'"});
  const fs::path twice = whole_store("store_twice");
  replace_in_file(twice / "store.json", "\"brick\"", "\"mug\"");
  expect_says(error_of_reading(twice), {"store.json", "'mug'", "expected one of each name"});
  const fs::path size = whole_store("store_size");
  replace_in_file(size / "models" / "models_info.json", "\"size_x\": 200", "\"size_x\": 300");
  expect_says(error_of_loading(size), {"obj_000005.ply", "200.0 x 200.0 x 200.0 mm", "300.0 x 200.0 x 200.0 mm"});
  const ObjectStore store = read_store(whole_store("store_forest"));
  EXPECT_EQ(error_of([&] { require_same_objects(store, {"brick", "mug"}); }), "");
  expect_says(error_of([&] {
                require_same_objects(store, {"brick", "bowl"});
              }),
              {"forest", "knows bowl, brick", "expected", "brick, mug"});
}

TEST(StoreBuild, TheOldStoreStaysWholeUntilTheNewOneIs) {
  const fs::path folder = whole_store("store_swap");
  {
    StoreBuild build(folder);
    fill(build.folder(), "bowl");
    EXPECT_EQ(read_store(folder).objects[1].name, "brick") << "before it is published";
    build.publish();
  }
  EXPECT_EQ(read_store(folder).objects[1].name, "bowl");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.parent_path()), {}), 1) << "nothing is left beside it";
}

TEST(StoreBuild, WhatIsGivenUpLeavesNothing) {
  const fs::path folder = whole_store("store_given_up");
  {
    StoreBuild build(folder);
    write_text(build.folder() / "forest", "half");
  }
  EXPECT_EQ(read_store(folder).objects[1].name, "brick");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.parent_path()), {}), 1);
}

TEST(StoreBuild, WhatAnInterruptedTeachingLeftIsRemoved) {
  const fs::path folder = whole_store("store_interrupted");
  const fs::path left = folder.parent_path() / ".store.partial-99999999";
  fs::create_directories(left / "models");
  const StoreBuild build(folder);
  EXPECT_FALSE(fs::exists(left));
  EXPECT_EQ(read_store(folder).objects[1].name, "brick");
  fs::remove_all(build.folder());
}

TEST(StoreBuild, AnOldStoreThatWasPutAsideComesBack) {
  const fs::path folder = whole_store("store_aside");
  fs::rename(folder, folder.parent_path() / ".store.before");
  const StoreBuild build(folder);
  EXPECT_EQ(read_store(folder).objects[1].name, "brick");
}

TEST(StoreBuild, OneAtATimeAndNothingElseIsReplaced) {
  const fs::path folder = whole_store("store_alone");
  const StoreBuild first(folder);
  expect_says(error_of([&] { StoreBuild second(folder); }), {folder.string(), "another teaching"});
  const fs::path other = fresh_folder("store_other");
  write_text(other / "holiday.jpg", "");
  expect_says(error_of([&] { StoreBuild build(other); }), {other.string(), "not replaced"});
  EXPECT_TRUE(fs::exists(other / "holiday.jpg"));
}

}  // namespace
}  // namespace houghstream::store
