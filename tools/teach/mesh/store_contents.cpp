#include "tools/teach/mesh/store_contents.hpp"

#include <algorithm>
#include <utility>

#include "detector/forest/forest_file.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pose/model/symmetry_search.hpp"
#include "tools/finder/stored_forest.hpp"
#include "tools/teach/mesh/contact_sheet.hpp"

namespace houghstream::teach {
namespace {

namespace fs = std::filesystem;
using store::ObjectStore;
using store::StoredObject;

void make_store_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  require(!error, "{}: cannot make this folder: {}", folder.string(), error.message());
}

/// Carries a model over. A mesh of another id names its texture by that id.
void carry_model_over(const StoreModel& from, const fs::path& models_folder, Carrying carrying) {
  const fs::path to = bop_mesh_file(models_folder, from.model.object_id);
  const fs::path to_texture = fs::path(to).replace_extension(".png");
  const fs::path texture = fs::path(from.file).replace_extension(".png");
  const bool has_texture = fs::exists(texture);
  if (has_texture) carry_over(texture, to_texture, carrying);
  if (!has_texture || from.file.filename() == to.filename()) return carry_over(from.file, to, carrying);
  std::string text = read_file(from.file, "a mesh");
  const std::string named = "TextureFile " + texture.filename().string();
  const std::size_t place = text.substr(0, text.find("end_header")).find(named);
  require(place != std::string::npos, "{}: names no texture, expected {}", from.file.string(), named);
  text.replace(place, named.size(), "TextureFile " + to_texture.filename().string());
  write_file_atomically(to, text);
}

/// Meshes that were there before keep their files and what is said of them.
void write_models(std::vector<StoreModel> models, const fs::path& folder, Carrying carrying) {
  std::vector<NamedModel> new_models;
  for (StoreModel& it : models) {
    if (it.file.empty()) new_models.push_back(std::move(it.model));
  }
  write_bop_models(new_models, folder);
  const fs::path info_file = folder / "models_info.json";
  OrderedJson written = OrderedJson::parse(read_file(info_file, "a list of models"));
  OrderedJson info = OrderedJson::object();
  std::map<int, std::string> names;
  std::size_t next = 0;
  for (const StoreModel& it : models) {
    const NamedModel& model = it.file.empty() ? new_models[next++] : it.model;
    const std::string key = std::to_string(model.object_id);
    names[model.object_id] = model.name;
    info[key] = it.file.empty() ? written.at(key) : it.info;
    if (!it.file.empty()) carry_model_over(it, folder, carrying);
  }
  write_json(info, info_file);
  write_bop_names(names, folder / "names.json");
}

}  // namespace

int number_of(const Forest& forest, const ObjectStore& list) {
  return store::find_object(list, forest.classes.front().name).group;
}

StoreContents read_contents(const fs::path& folder) {
  StoreContents contents;
  contents.list = store::read_store(folder);
  contents.meshes = store::load_store_meshes(contents.list);
  for (const int group : contents.list.groups())
    contents.groups.push_back({load_group_forest(contents.list, group), contents.list.forest_file(group)});
  return contents;
}

ObjectStore start_store(const fs::path& folder) {
  ObjectStore store;
  store.folder = folder;
  make_store_folder(folder / "views");
  return store;
}

std::map<int, OrderedJson> read_model_entries(const ObjectStore& list) {
  const fs::path file = list.models_folder() / "models_info.json";
  const OrderedJson info = OrderedJson::parse(read_file(file, "a list of models"));
  std::map<int, OrderedJson> entries;
  for (const StoredObject& object : list.objects) entries[object.id] = info.at(std::to_string(object.id));
  return entries;
}

void carry_over(const fs::path& file, const fs::path& to, Carrying carrying) {
  std::error_code error;
  if (carrying == Carrying::kLinked) fs::create_hard_link(file, to, error);
  if (carrying == Carrying::kCopied || error) fs::copy_file(file, to, error);
  require(!error, "{}: cannot be copied: {}", file.string(), error.message());
}

void copy_objects(const StoreContents& old, const std::string& except, ObjectStore& new_store,
                  std::vector<StoreModel>& models) {
  std::map<int, OrderedJson> entries;
  if (!old.list.objects.empty()) entries = read_model_entries(old.list);
  for (const StoredObject& object : old.list.objects) {
    if (object.name == except) continue;
    new_store.objects.push_back(object);
    if (std::optional<store::PracticeRecord>& practice = new_store.objects.back().practice)
      practice->taken_for.erase(except);
    std::optional<ShapeSymmetry>& shape = new_store.objects.back().shape_symmetry;
    if (!shape) shape = find_shape_symmetry(old.meshes.at(object.name));  // taught before it was looked for
    StoreModel& kept = models.emplace_back();
    kept.model = {object.id, object.name, old.meshes.at(object.name), old.list.symmetries.at(object.id)};
    kept.file = old.list.mesh_file(object.id);
    kept.info = entries.at(object.id);
    carry_over(old.list.view_image(object.id), new_store.view_image(object.id));
  }
}

void write_store(ObjectStore list, std::vector<StoreModel> models, const std::vector<GroupForest>& groups,
                 Carrying carrying) {
  std::sort(list.objects.begin(), list.objects.end(),
            [](const StoredObject& a, const StoredObject& b) { return a.id < b.id; });
  store::number_groups(list);
  write_models(std::move(models), list.models_folder(), carrying);
  if (groups.size() > 1) make_store_folder(list.forests_folder());
  for (const auto& [forest, file] : groups) {
    const fs::path to = list.forest_file(number_of(forest, list));
    file.empty() ? save_forest(forest, to) : carry_over(file, to, carrying);
  }
  std::vector<fs::path> images;
  for (const StoredObject& object : list.objects) images.push_back(list.view_image(object.id));
  write_contact_sheet(images, list.contact_sheet());
  list.tone = groups.front().forest.features.tone;
  store::write_store_json(list);
  const ObjectStore written = store::read_store(list.folder);
  for (const int group : written.groups()) load_group_forest(written, group);
}

}  // namespace houghstream::teach
