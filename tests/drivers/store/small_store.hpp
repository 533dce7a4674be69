#pragma once

#include <map>
#include <string>

#include "drivers/datasets/bop_writer.hpp"
#include "drivers/store/object_store.hpp"
#include "drivers/store/store_transaction.hpp"
#include "tests/pipeline/geometry/tetrahedron.hpp"
#include "tests/test_files.hpp"

namespace houghstream::store {

/// Fills an existing folder with a whole store of a mug and of a second object by its name.
inline void fill_store(const std::filesystem::path& folder, const std::string& second_name) {
  ObjectStore store;
  store.folder = folder;
  store.objects = {{2, "mug", "cad/mug.ply", true, 12, "resting", {0.0F, 0.0F, 0.0F}, nullptr},
                   {5, second_name, "cad/b.ply", false, 34, "any", {0.0F, 0.01F, -0.5F}, {{"least", 0.5}}}};
  store.settings = {{"seed", 1}};
  Symmetries half_turn;
  half_turn.discrete.emplace_back(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitZ()));
  Mesh mug = tetrahedron(0.1F);
  Mesh second = tetrahedron(0.2F);
  for (Mesh* mesh : {&mug, &second}) mesh->colours.assign(mesh->vertices.size(), {128, 128, 128});
  write_bop_models({{2, "mug", mug, half_turn}, {5, second_name, second, {}}}, store.models_folder());
  write_text(store.forest_file(0), "a forest");
  write_store_json(store);
}

/// Makes a whole store of a mug and a brick, in a folder of its own.
inline std::filesystem::path whole_store(const std::string& name) {
  std::filesystem::path folder = fresh_folder(name) / "store";
  std::filesystem::create_directories(folder);
  fill_store(folder, "brick");
  return folder;
}

/// Returns all files of a folder, byte for byte, by their paths.
inline std::map<std::string, std::string> files_of(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) files[entry.path().string()] = read_text(entry.path());
  }
  return files;
}

/// Replaces the store by one of a mug and of `second`, as teaching does it.
inline void exchange(const std::filesystem::path& folder, const std::string& second) {
  StoreTransaction build(folder);
  fill_store(build.folder(), second);
  build.commit();
}

}  // namespace houghstream::store
