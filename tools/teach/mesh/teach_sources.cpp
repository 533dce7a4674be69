#include "tools/teach/mesh/teach_sources.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <map>
#include <set>
#include <sstream>

#include "drivers/datasets/bop_dataset.hpp"
#include "drivers/store/object_store.hpp"
#include "pipeline/base/cache_folder.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/base/folder_exchange.hpp"
#include "pipeline/base/log_line.hpp"
#include "tools/render/render_jobs.hpp"
#include "tools/teach/mesh/mesh_checks.hpp"
#include "tools/train/training_sources.hpp"

namespace houghstream::teach {
namespace {

namespace fs = std::filesystem;

constexpr double kMillimetre = 1e-3;

std::string lower_extension(const fs::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

bool is_mesh_file(const fs::path& file) {
  const std::string extension = lower_extension(file);
  return extension == ".ply" || extension == ".obj" || extension == ".stl" || extension == ".glb" ||
         extension == ".gltf";
}

double unit_of(const fs::path& file, const MeshSources& sources) {
  const std::string extension = lower_extension(file);
  const bool is_gltf = extension == ".glb" || extension == ".gltf";  // glTF's standard says metres
  return sources.unit_m.value_or(is_gltf ? 1.0 : kMillimetre);
}

/// Requires the file of materials that an OBJ names, without which it would be taught without its colours.
void require_materials(const fs::path& file) {
  if (lower_extension(file) != ".obj") return;
  constexpr const char* kWord = "mtllib ";
  std::istringstream in(read_file(file, "an OBJ mesh"));
  for (std::string line; std::getline(in, line);) {
    if (line.rfind(kWord, 0) != 0) continue;
    std::string name = line.substr(std::string(kWord).size());
    name.erase(name.find_last_not_of(" \r\t") + 1);
    require(fs::exists(file.parent_path() / name), "{}: missing, expected the materials of {}",
            (file.parent_path() / name).string(), file.string());
  }
}

TaughtMesh read_mesh(int id, const std::string& name, const fs::path& file, double unit_m) {
  TaughtMesh taught;
  taught.id = id;
  taught.name = name;
  taught.file = file;
  require_materials(file);
  taught.mesh = load_mesh(file, unit_m);
  check_mesh(file.string(), unit_m, taught.mesh);
  taught.coloured = has_colour(taught.mesh);
  if (!taught.coloured) remove_colour(taught.mesh);
  return taught;
}

int parse_id(const std::string& text) {
  int id = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), id);
  require(result.ec == std::errc() && result.ptr == text.data() + text.size() && id >= 1,
          "--ids '{}', expected an object's id, from 1 on", text);
  return id;
}

void append_bop_folder(const fs::path& folder, const MeshSources& sources, std::vector<TaughtMesh>& meshes) {
  const BopModels models = read_bop_models(folder);
  std::set<int> wanted;
  for (const std::string& id : sources.ids)
    require(wanted.insert(parse_id(id)).second, "--ids {}: stands there twice, expected each id once", id);
  for (const int id : wanted) {
    require(models.diameters.count(id) == 1, "--ids {}: {} has no such object", id,
            (folder / "models_info.json").string());
  }
  for (const auto& [id, diameter] : models.diameters) {
    if (!wanted.empty() && wanted.count(id) == 0) continue;
    const fs::path file = models.mesh_file(id);
    meshes.push_back(read_mesh(id, models.names.at(id), file, sources.unit_m.value_or(kMillimetre)));
    const auto stated = models.bounds.find(id);
    if (stated != models.bounds.end()) store::check_bounds(meshes.back().mesh, stated->second, file.string());
    meshes.back().symmetries = models.symmetries.at(id);
    const std::string where = fmt::format("{} object {}", (folder / "models_info.json").string(), id);
    check_symmetries(where, meshes.back().mesh, meshes.back().symmetries);
  }
}

void append_plain_folder(const fs::path& folder, const MeshSources& sources, std::vector<TaughtMesh>& meshes) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (is_mesh_file(entry.path())) files.push_back(entry.path());
  }
  require(!files.empty(), "{}: neither models_info.json nor any NAME.ply, NAME.obj, NAME.stl, NAME.glb",
          folder.string());
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) meshes.push_back(read_mesh(0, file.stem().string(), file, unit_of(file, sources)));
}

/// Returns how a mesh of a common format that is not read becomes one that is; empty for other files.
std::string conversion_of(const fs::path& file) {
  for (const char* extension : {".dae", ".3ds", ".off", ".x3d"}) {
    if (file.extension() != extension) continue;
    return fmt::format("; assimp export {} {} makes one (Debian's assimp-utils)", file.string(),
                       fs::path(file).replace_extension(".ply").string());
  }
  return "";
}

/// Renames objects, by id or by old name. Throws InputError for a name without effect.
void rename(const std::vector<std::string>& renames, std::vector<TaughtMesh>& meshes) {
  std::set<std::string> renamed;
  for (const std::string& rename : renames) {
    const std::size_t equals = rename.find('=');
    require(equals != std::string::npos && equals > 0 && equals + 1 < rename.size(),
            "--names '{}', expected ID=NAME, for instance 2=cracker", rename);
    const std::string which = rename.substr(0, equals);
    const auto found = std::find_if(meshes.begin(), meshes.end(), [&](const TaughtMesh& mesh) {
      return mesh.id > 0 ? std::to_string(mesh.id) == which : mesh.file.stem().string() == which;
    });
    require(found != meshes.end(), "--names '{}': no object '{}' is read", rename, which);
    require(renamed.insert(which).second, "--names '{}': '{}' has another new name already", rename, which);
    found->name = rename.substr(equals + 1);
  }
}

/// Returns the option that gives an object, which is called as its file, a name without what no name may hold; where it
/// needs none, or the option could not be written so, "--names" alone.
std::string renaming_option(const TaughtMesh& mesh) {
  const std::string which = mesh.file.stem().string();
  if (mesh.id > 0 || mesh.name != which) return "--names";
  std::string word = which;
  for (char& letter : word) {
    if (std::string(" ,/\\=").find(letter) != std::string::npos) letter = '_';
  }
  if (word == which || which.find_first_of(",=") != std::string::npos) return "--names";
  return fmt::format("--names '{}={}'", which, word);
}

void require_names(const std::vector<TaughtMesh>& meshes) {
  for (const TaughtMesh& mesh : meshes)
    store::require_new_name(mesh.name, fmt::format("{} ({})", mesh.file.string(), renaming_option(mesh)));
}

void require_different(const std::vector<TaughtMesh>& meshes) {
  std::map<std::string, std::string> files;  // files by name
  std::map<int, std::string> files_by_id;
  for (const TaughtMesh& mesh : meshes) {
    const auto [other, is_new] = files.emplace(mesh.name, mesh.file.string());
    require(is_new, "{}: is called '{}' as {} is, expected one object of each name (--names)", mesh.file.string(),
            mesh.name, other->second);
    if (mesh.id == 0) continue;
    const auto [same, is_first] = files_by_id.emplace(mesh.id, mesh.file.string());
    require(is_first, "{}: has the id {} as {} has, expected one object of each id", mesh.file.string(), mesh.id,
            same->second);
  }
}

namespace fs = std::filesystem;

/// Version of the rendered backgrounds, to be raised when they change.
constexpr int kRoomsVersion = 1;
constexpr std::uint64_t kRoomsSeed = 1;

/// Removes the remains of interrupted renderings; their names end in the process' number.
void remove_leftovers(const fs::path& cache, const std::string& prefix) {
  for (const auto& entry : fs::directory_iterator(cache)) {
    const std::string name = entry.path().filename().string();
    if (name.rfind(prefix, 0) != 0) continue;
    const int process = std::atoi(name.substr(prefix.size()).c_str());
    if (process > 0 && (kill(process, 0) == 0 || errno == EPERM)) continue;
    std::error_code error;
    fs::remove_all(entry.path(), error);
  }
}

/// Returns the folder of the rendered rooms; renders them beside it first where it is missing, so that it is always
/// whole.
fs::path render_backgrounds(const BackgroundSettings& settings) {
  const fs::path cache = settings.cache.empty() ? cache_folder("--cache FOLDER") : settings.cache;
  fs::path rooms = cache / fmt::format("rooms-{}-{}", kRoomsVersion, settings.count);
  if (fs::exists(rooms / "scene_gt_info.json")) return rooms;
  std::error_code error;
  fs::create_directories(cache, error);
  require(!error, "{}: cannot make this folder: {}; --cache names another", cache.string(), error.message());
  const std::string prefix = rooms.filename().string() + ".partial-";
  remove_leftovers(cache, prefix);
  const fs::path partial = cache / (prefix + std::to_string(getpid()));
  log_info("rooms are rendered once into {}", rooms.string());
  render::RenderOptions options;
  options.out = partial;
  options.seed = kRoomsSeed;
  options.threads = settings.threads;
  options.replace = true;  // replaces the remains of an interrupted process of this number
  render::render_background(options, settings.count);
  sync_folder_to_disk(partial);  // a power cut must not leave half of it for every later teaching
  fs::rename(partial, rooms, error);
  if (error) {  // another teaching was faster
    require(fs::exists(rooms / "scene_gt_info.json"), "{}: cannot be written: {}", rooms.string(), error.message());
    fs::remove_all(partial);
  }
  return rooms;
}

}  // namespace

std::vector<TaughtMesh> read_meshes(const MeshSources& sources) {
  std::vector<TaughtMesh> meshes;
  bool any_bop = false;
  for (const fs::path source : sources.sources) {
    if (fs::exists(source / "models_info.json")) {
      any_bop = true;
      append_bop_folder(source, sources, meshes);
    } else if (fs::is_directory(source)) {
      append_plain_folder(source, sources, meshes);
    } else {
      require(fs::exists(source), "{}: no such file or folder, expected a mesh or a folder of meshes", source.string());
      require(is_mesh_file(source), "{}: expected a mesh: PLY, OBJ, STL, GLB or glTF{}", source.string(),
              conversion_of(source));
      meshes.push_back(read_mesh(0, source.stem().string(), source, unit_of(source, sources)));
    }
  }
  require(any_bop || sources.ids.empty(), "--ids goes with a BOP models folder (with models_info.json)");
  rename(sources.names, meshes);
  require_names(meshes);
  require_different(meshes);
  return meshes;
}

std::vector<TrainingView> read_backgrounds(const BackgroundSettings& settings) {
  TrainingSources sources;
  sources.backgrounds = {"bop:" + render_backgrounds(settings).string()};
  sources.backgrounds.insert(sources.backgrounds.end(), settings.further.begin(), settings.further.end());
  sources.camera = settings.camera;
  return read_training_sources(sources, settings.threads);
}

}  // namespace houghstream::teach
