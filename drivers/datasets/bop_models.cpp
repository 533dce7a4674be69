#include <algorithm>

#include "drivers/datasets/bop_dataset.hpp"
#include "drivers/datasets/bop_symmetries.hpp"
#include "drivers/files/json_file.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/parallel.hpp"
#include "pipeline/base/require_folder.hpp"

namespace houghstream {
namespace {

namespace fs = std::filesystem;

/// Returns the diameter in metres; models_info.json has millimetres.
double parse_diameter(const nlohmann::json& entry, const std::string& where) {
  const double diameter_mm = json_number(entry, "diameter", where);
  constexpr double kMax_mm = 1e5;
  require(diameter_mm > 0.0 && diameter_mm < kMax_mm, "{}: 'diameter' is {} mm, expected 0 to {}", where, diameter_mm,
          kMax_mm);
  return diameter_mm * 1e-3;
}

Eigen::AlignedBox3d parse_bounds(const nlohmann::json& entry, const std::string& where) {
  const auto vector_mm = [&](const std::string& name) {
    return Eigen::Vector3d(json_number(entry, name + "_x", where), json_number(entry, name + "_y", where),
                           json_number(entry, name + "_z", where));
  };
  const Eigen::Vector3d low_mm = vector_mm("min");
  const Eigen::Vector3d size_mm = vector_mm("size");
  require(size_mm.minCoeff() >= 0.0, "{}: 'size' is {} x {} x {} mm, expected none below 0", where, size_mm.x(),
          size_mm.y(), size_mm.z());
  return {low_mm * 1e-3, (low_mm + size_mm) * 1e-3};
}

/// CAD models as people keep them: the file's name is the object's.
std::vector<std::pair<std::string, fs::path>> named_files(const fs::path& folder) {
  require_folder(folder, "models");
  std::vector<std::pair<std::string, fs::path>> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string extension = entry.path().extension().string();
    if (extension == ".ply" || extension == ".obj") files.emplace_back(entry.path().stem().string(), entry.path());
  }
  require(!files.empty(), "{}: neither models_info.json nor any NAME.ply or NAME.obj{}", folder.string(),
          fs::exists(folder / "models/models_info.json")
              ? fmt::format("; did you mean {}?", (folder / "models").string())
              : "");
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

fs::path bop_mesh_file(const fs::path& models_folder, int object_id) {
  return models_folder / fmt::format("obj_{:06d}.ply", object_id);
}

fs::path BopModels::mesh_file(int object_id) const {
  return bop_mesh_file(folder, object_id);
}

std::map<int, std::string> read_bop_names(const fs::path& names_file) {
  std::map<int, std::string> names;
  for (const auto& [object_id, value] : read_json_by_id(names_file)) {
    require(value.is_string() && !value.get<std::string>().empty(), "{}: name of object {} is {}, expected a text",
            names_file.string(), object_id, json_text(value));
    names[object_id] = value.get<std::string>();
  }
  return names;
}

BopModels read_bop_models(const fs::path& models_folder) {
  const fs::path info_file = models_folder / "models_info.json";
  const fs::path names_file = models_folder / "names.json";
  BopModels models;
  models.folder = models_folder;
  if (fs::exists(names_file)) models.names = read_bop_names(names_file);
  for (const auto& [object_id, entry] : read_json_by_id(info_file)) {
    const std::string where = fmt::format("{} object {}", info_file.string(), object_id);
    models.diameters[object_id] = parse_diameter(entry, where);
    if (entry.contains("min_x")) models.bounds[object_id] = parse_bounds(entry, where);
    models.symmetries[object_id] = symmetries_from_json(entry, where);
    models.names.try_emplace(object_id, fmt::format("object_{}", object_id));
  }
  return models;
}

std::map<std::string, Mesh> load_class_models(const fs::path& models_folder, double unit_m, int threads) {
  std::vector<std::pair<std::string, fs::path>> files;  // files by class name
  if (fs::exists(models_folder / "models_info.json")) {
    const BopModels models = read_bop_models(models_folder);
    for (const auto& [object_id, diameter] : models.diameters) {
      files.emplace_back(models.names.at(object_id), models.mesh_file(object_id));
    }
  } else {
    files = named_files(models_folder);
  }
  std::map<std::string, Mesh> meshes;
  std::vector<Mesh*> places;
  for (const auto& [name, file] : files) {
    const auto [place, is_new] = meshes.try_emplace(name);
    require(is_new, "{}: two models are called '{}', expected one of each name", models_folder.string(), name);
    places.push_back(&place->second);
  }
  parallel_for(threads, static_cast<int>(files.size()), [&](int i) {
    const auto index = static_cast<std::size_t>(i);
    *places[index] = load_mesh(files[index].second, unit_m);
  });
  return meshes;
}

std::map<std::string, Symmetries> load_class_symmetries(const fs::path& models_folder) {
  std::map<std::string, Symmetries> symmetries;
  if (!fs::exists(models_folder / "models_info.json")) return symmetries;
  const BopModels models = read_bop_models(models_folder);
  for (const auto& [id, of_object] : models.symmetries) symmetries[models.names.at(id)] = of_object;
  return symmetries;
}

std::optional<fs::path> find_bop_models(const fs::path& folder) {
  // A scene lies at most DATASET/SPLIT/SCENE deep.
  constexpr int kLevels = 3;
  fs::path above = fs::absolute(folder).lexically_normal();
  if (!above.has_filename()) above = above.parent_path();
  for (int level = 0; level <= kLevels; ++level, above = above.parent_path()) {
    if (fs::exists(above / "models" / "models_info.json")) return above / "models";
  }
  return std::nullopt;
}

std::map<int, std::string> find_bop_names(const fs::path& scene_folder) {
  if (fs::exists(scene_folder / "names.json")) return read_bop_names(scene_folder / "names.json");
  if (const auto models = find_bop_models(scene_folder)) return read_bop_models(*models).names;
  return {};
}

}  // namespace houghstream
