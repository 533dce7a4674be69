#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/geometry/mesh.hpp"
#include "pipeline/geometry/symmetry.hpp"
#include "pipeline/types/training_view.hpp"

namespace houghstream::teach {

/// Places of meshes, as the command line names them.
struct MeshSources {
  std::vector<std::string> sources;  ///< mesh files; BOP models folders (with models_info.json); folders of meshes
  std::optional<double> unit_m;      ///< unit of the files' coordinates; without it millimetres, for glTF metres
  std::vector<std::string> names;    ///< "2=cracker": an object of a BOP folder by id, or of a file by its name
  std::vector<std::string> ids;      ///< ids of a BOP folder's objects to teach; empty = all
};

/// A mesh to be taught, checked.
struct TaughtMesh {
  int id = 0;  ///< id in a BOP folder; 0 = to be given
  std::string name;
  std::filesystem::path file;
  Mesh mesh;  ///< metres; without colours where it is not coloured
  Symmetries symmetries;
  bool coloured = true;  ///< false: no colour, or nothing but one grey
};

/// Reads and checks them all (mesh_checks.hpp). Throws InputError with one line for what cannot be taught, for two
/// objects of one name or id, a name that is not UTF-8, and for names and ids that have no effect.
std::vector<TaughtMesh> read_meshes(const MeshSources& sources);

/// Rooms without the objects, to teach what they are not.
struct BackgroundSettings {
  std::filesystem::path cache;        ///< folder in which rendered rooms are kept; empty = cache_folder()
  std::vector<std::string> further;   ///< a user's own, beside the rendered ones: "bop:DIR" or "images:DIR"
  std::optional<std::string> camera;  ///< camera of images:DIR, see parse_camera
  int count = 215;                    ///< rendered frames
  int threads = 2;
};

/// Reads the rendered rooms, which are rendered into the cache where it lacks them, and the user's. Throws InputError
/// where a folder cannot be written or read.
std::vector<TrainingView> read_backgrounds(const BackgroundSettings& settings);

}  // namespace houghstream::teach
