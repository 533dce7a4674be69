#include "drivers/store/object_store.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "drivers/datasets/bop_dataset.hpp"
#include "drivers/datasets/bop_symmetries.hpp"
#include "pipeline/base/check_settings.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/base/parallel.hpp"
#include "pipeline/base/printable.hpp"
#include "pipeline/base/require_folder.hpp"

namespace houghstream::store {
namespace {

namespace fs = std::filesystem;

constexpr const char* kJsonFile = "store.json";
constexpr const char* kForestFile = "forest";  // of the only group
constexpr const char* kForestsFolder = "forests";
constexpr const char* kVersionKey = "houghstream_store";

std::string text(const nlohmann::json& entry, const char* key, const std::string& where) {
  const auto found = entry.find(key);
  require(found != entry.end() && found->is_string() && !found->get<std::string>().empty(),
          "{}: '{}' is {}, expected a text", where, key, found == entry.end() ? "missing" : json_text(*found));
  return found->get<std::string>();
}

bool truth(const nlohmann::json& entry, const char* key, const std::string& where) {
  const auto found = entry.find(key);
  require(found != entry.end() && found->is_boolean(), "{}: '{}' is {}, expected true or false", where, key,
          found == entry.end() ? "missing" : json_text(*found));
  return found->get<bool>();
}

/// Returns the vote centre of an entry; the origin for a store that states none.
Eigen::Vector3f vote_centre(const nlohmann::json& entry, const std::string& where) {
  if (!entry.contains("vote_centre_m")) return Eigen::Vector3f::Zero();
  const std::vector<double> xyz = json_numbers(entry, "vote_centre_m", 3, where);
  Eigen::Vector3f centre = Eigen::Vector3d(xyz[0], xyz[1], xyz[2]).cast<float>();
  require(centre.norm() < kMaxCentre_m, "{}: 'vote_centre_m' is {}, expected x, y, z in metres", where,
          json_text(entry.at("vote_centre_m")));
  return centre;
}

constexpr const char* kGroupKey = "group";
constexpr const char* kTaughtIdKey = "taught_id";
constexpr const char* kPracticeKey = "practice";
constexpr const char* kShapeKey = "shape_symmetries";
constexpr const char* kRoundKey = "nearly_round";

std::optional<ShapeSymmetry> shape_symmetry(const nlohmann::json& object, const std::string& where) {
  const auto found = object.find(kShapeKey);
  if (found == object.end()) return std::nullopt;
  require(found->is_object(), "{}: '{}' is {}, expected lists of symmetries", where, kShapeKey, json_text(*found));
  const std::string place = fmt::format("{} '{}'", where, kShapeKey);
  require_known_names(*found, {"symmetries_discrete", "symmetries_continuous", kRoundKey}, place);
  ShapeSymmetry shape;
  shape.symmetries = symmetries_from_json(*found, place);
  if (found->contains(kRoundKey)) shape.nearly_round = axis_from_json(found->at(kRoundKey), kRoundKey, place);
  return shape;
}

OrderedJson to_json(const ShapeSymmetry& shape) {
  OrderedJson json = OrderedJson::object();
  add_symmetries(shape.symmetries, json);
  if (shape.nearly_round) json[kRoundKey] = axis_to_json(*shape.nearly_round);
  return json;
}

constexpr const char* kFramesKey = "frames";

/// {"handle": {"translation_m": [x, y, z], "rotation": [w, x, y, z]}}
std::vector<ObjectFrame> object_frames(const nlohmann::json& object, const std::string& where) {
  std::vector<ObjectFrame> frames;
  const auto found = object.find(kFramesKey);
  if (found == object.end()) return frames;
  require(found->is_object(), "{}: '{}' is {}, expected frames by name", where, kFramesKey, json_text(*found));
  for (const auto& [name, entry] : found->items()) {
    const std::string place = fmt::format("{} frame '{}'", where, name);
    require_new_name(name, place);
    require_known_names(entry, {"translation_m", "rotation"}, place);
    const std::vector<double> xyz = json_numbers(entry, "translation_m", 3, place);
    const std::vector<double> wxyz = json_numbers(entry, "rotation", 4, place);
    frames.push_back({name, object_frame_pose({xyz[0], xyz[1], xyz[2]}, {wxyz[0], wxyz[1], wxyz[2], wxyz[3]}, place)});
  }
  return frames;  // nlohmann::json keeps names sorted
}

OrderedJson to_json(const std::vector<ObjectFrame>& frames) {
  OrderedJson json = OrderedJson::object();
  for (const ObjectFrame& frame : frames) {
    const Eigen::Vector3d xyz = frame.T_object_frame.translation();
    const Eigen::Quaterniond q(frame.T_object_frame.linear());
    json[frame.name]["translation_m"] = {xyz.x(), xyz.y(), xyz.z()};
    json[frame.name]["rotation"] = {q.w(), q.x(), q.y(), q.z()};
  }
  return json;
}

/// Returns the range of brightness; for a store that states none it holds every image.
BrightnessRange parse_tone(const nlohmann::json& json, const std::string& file) {
  BrightnessRange tone;
  const auto found = json.find("tone");
  if (found == json.end()) return tone;
  require(found->is_object(), "{}: 'tone' is {}, expected means and a deviation of grey values", file,
          json_text(*found));
  for_each_number(tone, [&](const auto& field, float& value) {
    value = static_cast<float>(json_number(*found, field.name, file));
  });
  check_settings(tone, file + ": 'tone'");
  return tone;
}

StoredObject parse_object(const nlohmann::json& entry, const std::string& file) {
  require(entry.is_object(), "{}: an object is {}, expected its id, name and more", file, json_text(entry));
  StoredObject object;
  object.id = json_integer(entry, "id", file);
  const std::string where = fmt::format("{} object {}", file, object.id);
  require_known_names(entry,
                      {"id", "name", "mesh", "coloured", "views", "attitudes", "vote_centre_m", kShapeKey, kFramesKey,
                       "quality", kGroupKey, kTaughtIdKey, kPracticeKey},
                      where);
  require(object.id >= 1, "{}: expected an id from 1 on", where);
  object.name = text(entry, "name", where);
  object.mesh = text(entry, "mesh", where);
  object.coloured = truth(entry, "coloured", where);
  object.views = json_integer(entry, "views", where);
  object.attitudes = text(entry, "attitudes", where);
  object.vote_centre = vote_centre(entry, where);
  object.shape_symmetry = shape_symmetry(entry, where);
  object.frames = object_frames(entry, where);
  if (entry.contains(kGroupKey)) object.group = json_integer(entry, kGroupKey, where);
  if (entry.contains(kTaughtIdKey)) object.taught_id = json_integer(entry, kTaughtIdKey, where);
  if (entry.contains(kPracticeKey))
    object.practice = practice_from_json(entry.at(kPracticeKey), fmt::format("{} '{}'", where, kPracticeKey));
  if (entry.contains("quality")) object.quality = entry.at("quality");
  require(object.quality.is_null() || object.quality.is_object(), "{}: 'quality' is {}, expected numbers by name",
          where, json_text(object.quality));
  return object;
}

std::vector<StoredObject> parse_objects(const nlohmann::json& json, const std::string& file) {
  const auto list = json.find("objects");
  require(list != json.end() && list->is_array() && !list->empty(), "{}: no 'objects', expected a list of at least one",
          file);
  std::vector<StoredObject> objects;
  std::set<int> ids;
  std::set<std::string> names;
  for (const nlohmann::json& entry : *list) {
    objects.push_back(parse_object(entry, file));
    require(ids.insert(objects.back().id).second, "{}: object {} is listed twice, expected each once", file,
            objects.back().id);
    require(names.insert(objects.back().name).second, "{}: two objects are called '{}', expected one of each name",
            file, objects.back().name);
  }
  std::sort(objects.begin(), objects.end(), [](const StoredObject& a, const StoredObject& b) { return a.id < b.id; });
  return objects;
}

/// Groups are called by the smallest of their ids: those of a list in which somebody has changed one are not.
void check_groups(const ObjectStore& store, const std::string& file) {
  ObjectStore numbered = store;
  number_groups(numbered);
  const bool has_numbers = std::any_of(store.objects.begin(), store.objects.end(),
                                       [](const StoredObject& object) { return object.group != 0; });
  for (std::size_t i = 0; i < store.objects.size(); ++i) {
    const StoredObject& object = store.objects[i];
    require(object.taught_id >= 0, "{} object {}: '{}' is {}, expected an id from 1 on", file, object.id, kTaughtIdKey,
            object.taught_id);
    require(!has_numbers || object.group == numbered.objects[i].group,
            "{} object {}: '{}' is {}, expected {}, the smallest id of its group", file, object.id, kGroupKey,
            object.group, numbered.objects[i].group);
  }
}

void require_file(const fs::path& file, const fs::path& store) {
  require(fs::is_regular_file(file), "{}: missing, expected it in the object store {}: half written; teach it again",
          file.string(), store.string());
}

/// Recognises an object store, a truncated one included, by the version at its beginning.
bool is_list_of_store(const fs::path& file) {
  if (!fs::is_regular_file(file)) return false;
  return read_file(file, "the list of an object store").find(fmt::format("\"{}\"", kVersionKey)) != std::string::npos;
}

/// Checks that the models of the store are those of its list, and that no entry has a name that is never read.
void check_models(const ObjectStore& store, const BopModels& models) {
  const fs::path info_file = store.models_folder() / "models_info.json";
  const std::string info = info_file.string();
  for (const auto& [id, entry] : read_json_by_id(info_file)) {
    require_known_names(entry,
                        {"diameter", "min_x", "min_y", "min_z", "size_x", "size_y", "size_z", "symmetries_discrete",
                         "symmetries_continuous"},
                        fmt::format("{} object {}", info, id));
  }
  for (const StoredObject& object : store.objects) {
    require_file(models.mesh_file(object.id), store.folder);
    require(models.diameters.count(object.id) > 0, "{}: no object {}, expected '{}' of {}", info, object.id,
            object.name, kJsonFile);
    const std::string& name = models.names.at(object.id);  // each that has a diameter has one
    require(name == object.name, "{}: object {} is called '{}', expected '{}' as in {}",
            (store.models_folder() / "names.json").string(), object.id, name, object.name, kJsonFile);
  }
  require(models.diameters.size() == store.objects.size(), "{}: {} objects, expected the {} of {}", info,
          models.diameters.size(), store.objects.size(), kJsonFile);
}

}  // namespace

fs::path ObjectStore::json_file() const {
  return folder / kJsonFile;
}

std::vector<int> ObjectStore::groups() const {
  std::set<int> numbers;
  for (const StoredObject& object : objects) numbers.insert(object.group);
  return {numbers.begin(), numbers.end()};
}

fs::path ObjectStore::forest_file(int group) const {
  return groups().size() < 2 ? folder / kForestFile : forests_folder() / fmt::format("{:06d}", group);
}

fs::path ObjectStore::forests_folder() const {
  return folder / kForestsFolder;
}

fs::path ObjectStore::models_folder() const {
  return folder / "models";
}

fs::path ObjectStore::mesh_file(int id) const {
  return bop_mesh_file(models_folder(), id);
}

fs::path ObjectStore::view_image(int id) const {
  return folder / "views" / fmt::format("obj_{:06d}.png", id);
}

fs::path ObjectStore::contact_sheet() const {
  return folder / "contact_sheet.jpg";
}

std::map<std::string, nlohmann::json> ObjectStore::quality() const {
  std::map<std::string, nlohmann::json> by_name;
  for (const StoredObject& object : objects) {
    if (!object.quality.is_null()) by_name[object.name] = object.quality;
  }
  return by_name;
}

std::map<std::string, Eigen::Vector3f> ObjectStore::vote_centres() const {
  std::map<std::string, Eigen::Vector3f> by_name;
  for (const StoredObject& object : objects) by_name[object.name] = object.vote_centre;
  return by_name;
}

std::map<std::string, Symmetries> ObjectStore::symmetries_by_name() const {
  std::map<std::string, Symmetries> by_name;
  for (const StoredObject& object : objects) {
    if (const auto known = symmetries.find(object.id); known != symmetries.end()) by_name[object.name] = known->second;
  }
  return by_name;
}

std::map<std::string, ShapeSymmetry> ObjectStore::shape_symmetries() const {
  std::map<std::string, ShapeSymmetry> by_name;
  for (const StoredObject& object : objects) {
    if (object.shape_symmetry) by_name[object.name] = *object.shape_symmetry;
  }
  return by_name;
}

ObjectStore read_store(const fs::path& folder) {
  require_folder(folder, "an object store of hs-teach");
  const fs::path file = folder / kJsonFile;
  require(fs::is_regular_file(file), "{}: missing, expected it in an object store: half written, or no store",
          file.string());
  const nlohmann::json json = read_json_object(file);
  const int version = json_integer(json, kVersionKey, file.string());
  require(
      version >= 1 && version <= kStoreVersion,
      "{}: object store of version {}, expected at most {}: it is newer than this program; update this, or teach it "
      "again",
      file.string(), version, kStoreVersion);
  require_known_names(json, {kVersionKey, "objects", "tone", "settings"}, file.string());
  ObjectStore store;
  store.folder = folder;
  store.objects = parse_objects(json, file.string());
  check_groups(store, file.string());
  number_groups(store);
  store.tone = parse_tone(json, file.string());
  if (json.contains("settings")) store.settings = json.at("settings");
  for (const int group : store.groups()) require_file(store.forest_file(group), folder);
  require_file(store.models_folder() / "models_info.json", folder);
  require_file(store.models_folder() / "names.json", folder);
  const BopModels models = read_bop_models(store.models_folder());
  check_models(store, models);
  store.symmetries = models.symmetries;
  return store;
}

const StoredObject& find_object(const ObjectStore& store, const std::string& name) {
  std::vector<std::string> names;
  for (const StoredObject& object : store.objects) names.push_back(object.name);
  const auto found = std::find(names.begin(), names.end(), name);
  require(found != names.end(), "{}: no '{}', expected one of {}", store.json_file().string(), name,
          fmt::join(names, ", "));
  return store.objects[static_cast<std::size_t>(found - names.begin())];
}

void check_bounds(const Mesh& mesh, const Eigen::AlignedBox3d& stated, const std::string& file) {
  constexpr double kTolerance = 0.02;  // fraction of the largest side
  const Eigen::AlignedBox3d box = mesh_bounds(mesh).cast<double>();
  const double off =
      std::max((box.min() - stated.min()).cwiseAbs().maxCoeff(), (box.max() - stated.max()).cwiseAbs().maxCoeff());
  const Eigen::Vector3d is = box.sizes() * 1e3;
  const Eigen::Vector3d said = stated.sizes() * 1e3;
  require(off <= kTolerance * stated.sizes().maxCoeff(),
          "{}: {:.1f} x {:.1f} x {:.1f} mm and up to {:.1f} mm off, expected the bounds that models_info.json states, "
          "{:.1f} x {:.1f} x {:.1f} mm",
          file, is.x(), is.y(), is.z(), off * 1e3, said.x(), said.y(), said.z());
}

std::map<std::string, Mesh> load_store_meshes(const ObjectStore& store, int threads) {
  const BopModels models = read_bop_models(store.models_folder());
  std::map<std::string, Mesh> meshes;
  std::vector<Mesh*> places;
  for (const StoredObject& object : store.objects) places.push_back(&meshes[object.name]);
  parallel_for(threads, static_cast<int>(places.size()), [&](int i) {
    const auto index = static_cast<std::size_t>(i);
    const int id = store.objects[index].id;
    const fs::path file = models.mesh_file(id);
    *places[index] = load_mesh(file);
    const auto stated = models.bounds.find(id);
    if (stated != models.bounds.end()) check_bounds(*places[index], stated->second, file.string());
    if (!store.objects[index].coloured) remove_colour(*places[index]);
  });
  return meshes;
}

void require_same_objects(const ObjectStore& store, int group, const std::vector<std::string>& forest_names) {
  std::set<std::string> listed;
  for (const StoredObject& object : store.objects) {
    if (object.group == group) listed.insert(object.name);
  }
  const std::set<std::string> known(forest_names.begin(), forest_names.end());
  require(known == listed, "{}: knows {}, expected the objects of {}: {}", store.forest_file(group).string(),
          fmt::join(known, ", "), store.json_file().string(), fmt::join(listed, ", "));
}

void number_groups(ObjectStore& store) {
  std::map<int, int> smallest;
  for (const StoredObject& object : store.objects) {
    const auto [known, is_new] = smallest.emplace(object.group, object.id);
    if (!is_new) known->second = std::min(known->second, object.id);
  }
  for (StoredObject& object : store.objects) object.group = smallest.at(object.group);
}

void write_store_json(const ObjectStore& store) {
  const bool has_groups = store.groups().size() > 1;
  const bool is_renumbered = std::any_of(store.objects.begin(), store.objects.end(),
                                         [](const StoredObject& object) { return object.taught_id != 0; });
  const bool has_practice = std::any_of(store.objects.begin(), store.objects.end(),
                                        [](const StoredObject& object) { return object.practice.has_value(); });
  constexpr int kVersionOfGroups = 2;
  OrderedJson json;
  json[kVersionKey] = has_practice ? kStoreVersion : has_groups || is_renumbered ? kVersionOfGroups : 1;
  json["objects"] = OrderedJson::array();
  for (const StoredObject& object : store.objects) {
    OrderedJson entry;
    entry["id"] = object.id;
    entry["name"] = object.name;
    if (has_groups) entry[kGroupKey] = object.group;
    if (object.taught_id != 0) entry[kTaughtIdKey] = object.taught_id;
    entry["mesh"] = object.mesh;
    entry["coloured"] = object.coloured;
    entry["views"] = object.views;
    entry["attitudes"] = object.attitudes;
    entry["vote_centre_m"] = {object.vote_centre.x(), object.vote_centre.y(), object.vote_centre.z()};
    if (object.shape_symmetry) entry[kShapeKey] = to_json(*object.shape_symmetry);
    if (!object.frames.empty()) entry[kFramesKey] = to_json(object.frames);
    if (!object.quality.is_null()) entry["quality"] = object.quality;
    if (object.practice) entry[kPracticeKey] = to_json(*object.practice);
    json["objects"].push_back(entry);
  }
  for_each_number(store.tone, [&](const auto& field, float value) { json["tone"][field.name] = value; });
  json["settings"] = store.settings;
  write_json(json, store.json_file());
}

Eigen::Isometry3d object_frame_pose(const Eigen::Vector3d& translation_m, const Eigen::Vector4d& wxyz,
                                    const std::string& where) {
  constexpr double kUnitTolerance = 1e-3;  // of numbers that somebody has typed
  require(translation_m.allFinite() && translation_m.norm() < kMaxCentre_m, "{}: at {}, {}, {}, expected metres", where,
          translation_m.x(), translation_m.y(), translation_m.z());
  require(wxyz.allFinite() && std::abs(wxyz.norm() - 1.0) <= kUnitTolerance,
          "{}: rotation {}, {}, {}, {}, expected a unit quaternion w, x, y, z", where, wxyz[0], wxyz[1], wxyz[2],
          wxyz[3]);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::Quaterniond(wxyz[0], wxyz[1], wxyz[2], wxyz[3]).normalized().toRotationMatrix();
  T.translation() = translation_m;
  return T;
}

void require_utf8_name(const std::string& name, const std::string& where) {
  require(is_utf8(name), "{}: the name '{}' is not UTF-8, expected one that JSON can hold", where, printable(name));
}

void require_new_name(const std::string& name, const std::string& where) {
  constexpr std::size_t kMaxLength = 100;
  require_utf8_name(name, where);
  const bool is_word = !name.empty() && name.front() != '.' && name.find_first_of(" ,/\\=") == std::string::npos;
  require(is_word && name.size() <= kMaxLength && printable(name) == name,
          "{}: the name '{}', expected a word of at most {} bytes without spaces, commas, slashes, '=' and a first dot",
          where, printable(name), kMaxLength);
}

std::vector<std::string> find_stores(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name.front() != '.' && is_list_of_store(entry->path() / kJsonFile)) names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

bool is_store_entry(const fs::path& relative) {
  static const std::set<std::string> files = {kJsonFile, kForestFile, "contact_sheet.jpg", "models/models_info.json",
                                              "models/names.json"};
  fs::path entry = relative;
  if (entry.extension() == kPartialEnding) entry.replace_extension();
  if (entry == "models" || entry == "views" || entry == kForestsFolder || files.count(entry.string()) > 0) return true;
  if (entry.parent_path() == kForestsFolder)
    return entry.filename().string().find_first_not_of("0123456789") == std::string::npos;
  // A mesh, its texture or an image of its views has a name such as obj_000001.ply.
  const std::string name = entry.stem().string();
  const bool is_of_object = name.size() > 4 && name.rfind("obj_", 0) == 0 &&
                            name.find_first_not_of("0123456789", 4) == std::string::npos && entry.has_extension();
  return is_of_object && (entry.parent_path() == "models" || entry.parent_path() == "views");
}

bool is_replaceable(const fs::path& folder) {
  if (!fs::exists(folder)) return true;
  return fs::is_directory(folder) && (fs::is_empty(folder) || is_list_of_store(folder / kJsonFile));
}

}  // namespace houghstream::store
