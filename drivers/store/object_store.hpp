#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "drivers/files/json_file.hpp"
#include "drivers/store/practice_record.hpp"
#include "pipeline/geometry/mesh.hpp"
#include "pipeline/geometry/symmetry.hpp"
#include "pipeline/types/brightness.hpp"
#include "pipeline/types/placed_objects.hpp"

// The object store is a folder with all data of the taught objects, which hs-teach writes and hs-detect and hs-pose
// take as one argument.

namespace houghstream::store {

/// Newest version of store.json; a newer one is refused. A store is written as the oldest version that can hold it:
/// one without records of practice as version 2, and of one group as version 1, which programs read that know neither.
constexpr int kStoreVersion = 3;

/// A vote centre is nearer to the origin than this, metres: farther away coordinates lose what a mesh shows.
constexpr float kMaxCentre_m = 10.0F;

/// Describes a taught object, as in store.json.
struct StoredObject {
  int id = 0;             ///< from 1, the number of its model and of its class in the forest
  std::string name;       ///< no two are the same
  std::string mesh;       ///< file that it was taught from, for people
  bool coloured = true;   ///< false: only its shape is known
  int views = 0;          ///< views from which it was taught
  std::string attitudes;  ///< attitudes in which it was shown: "resting", "upright" or "any"
  /// The point of its own frame for which it was taught to vote, metres: where detections' centres are.
  Eigen::Vector3f vote_centre = Eigen::Vector3f::Zero();
  nlohmann::json quality{};  ///< learnt settings of its poses' quality, an object; null where none were learnt
  std::optional<ShapeSymmetry> shape_symmetry{};  ///< unknown in a store that was taught before it was looked for
  std::vector<ObjectFrame> frames{};              ///< that somebody has named on it (hs-teach frame), by name
  /// The number of its group: the smallest id among the group's objects; 0 in a list that was not written yet, where
  /// all are of one group.
  int group = 0;
  int taught_id = 0;                         ///< id with which it was taught, where a merge gave it another; 0: id
  std::optional<PracticeRecord> practice{};  ///< unknown in a store that was last practised before it was counted
};

struct ObjectStore {
  std::filesystem::path folder;
  std::vector<StoredObject> objects;        ///< in the order of their ids
  BrightnessRange tone;                     ///< brightness of the images of their calibration
  OrderedJson settings;                     ///< settings of the last teaching, for people
  std::map<int, Symmetries> symmetries;     ///< symmetries of models_info.json by id; empty for an object without any
  std::filesystem::path json_file() const;  ///< the list
  std::vector<int> groups() const;          ///< StoredObject::group of all objects, each once, ascending
  std::filesystem::path forest_file(int group) const;           ///< file of a group's detector
  std::filesystem::path forests_folder() const;                 ///< folder of the forests of a store of several groups
  std::filesystem::path models_folder() const;                  ///< a BOP models folder
  std::filesystem::path mesh_file(int id) const;                ///< an object's mesh in it
  std::filesystem::path view_image(int id) const;               ///< some of its views, side by side
  std::filesystem::path contact_sheet() const;                  ///< the images of all objects
  std::map<std::string, nlohmann::json> quality() const;        ///< quality settings by name, of objects that have any
  std::map<std::string, Eigen::Vector3f> vote_centres() const;  ///< vote centres by name
  std::map<std::string, ShapeSymmetry> shape_symmetries() const;  ///< shape symmetries by name, where they are known
  std::map<std::string, Symmetries> symmetries_by_name() const;
};

/// Reads store.json and models_info.json, no mesh and no forest. Throws InputError with one line that names file, value
/// and expectation where the folder is no store, half written, of another version, lacks a file, or where its parts
/// contradict one another.
ObjectStore read_store(const std::filesystem::path& folder);

/// Returns the object of this name. Throws InputError that lists the store's where there is none.
const StoredObject& find_object(const ObjectStore& store, const std::string& name);

/// Loads the meshes by name, metres, read on `threads` threads; without their colours where the store states that these
/// are unknown. Throws InputError where one cannot be read or has another size than in models_info.json.
std::map<std::string, Mesh> load_store_meshes(const ObjectStore& store, int threads = 1);

/// Throws InputError naming the mesh's file where it has other bounds than its models_info.json states, metres, by more
/// than 2 % of the largest side.
void check_bounds(const Mesh& mesh, const Eigen::AlignedBox3d& stated, const std::string& file);

/// Throws InputError where the forest of the group, whose classes have these names, is not that of the store.
void require_same_objects(const ObjectStore& store, int group, const std::vector<std::string>& forest_names);

/// Names each group by the smallest id of its objects, as a store that is written has it.
void number_groups(ObjectStore& store);

/// Writes FOLDER/store.json, last of all files: a folder without it is half written. The groups are numbered.
void write_store_json(const ObjectStore& store);

/// Throws InputError naming `where` for an object's name that is not UTF-8: JSON would hold another one (RFC 8259,
/// section 8.1), and the parts of the store would contradict one another.
void require_utf8_name(const std::string& name, const std::string& where);

/// Throws InputError naming `where` for a new object's name that lists, tables or files could not hold: it is a word of
/// at most 100 bytes of UTF-8, without commas, slashes, '=' and control characters, and no dot comes first.
void require_new_name(const std::string& name, const std::string& where);

/// Makes the pose of a named frame in its object's frame, from metres and a quaternion w, x, y, z. Throws InputError
/// naming `where` for one that is farther away than kMaxCentre_m, and for a quaternion of another length than 1.
Eigen::Isometry3d object_frame_pose(const Eigen::Vector3d& translation_m, const Eigen::Vector4d& wxyz,
                                    const std::string& where);

/// Returns the names of the folders in `folder` that are object stores, torn ones included, sorted.
std::vector<std::string> find_stores(const std::filesystem::path& folder);

/// Returns whether a path, relative to a store's folder, is one of a store's own entries, whole or being written. All
/// other entries of the folder are foreign and are kept (pipeline/base/folder_exchange.hpp).
bool is_store_entry(const std::filesystem::path& relative);

/// Returns whether the folder may be replaced: it is empty, or holds a store or the remains of one. A foreign
/// store.json makes no store.
bool is_replaceable(const std::filesystem::path& folder);

}  // namespace houghstream::store
