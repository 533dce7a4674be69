#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "detector/forest/forest.hpp"
#include "drivers/datasets/bop_writer.hpp"
#include "drivers/store/object_store.hpp"

namespace houghstream::teach {

/// The forest of a group of a store.
struct GroupForest {
  Forest forest;               ///< its classes have the ids of the store's list
  std::filesystem::path file;  ///< file that holds it as it is, and is carried over; empty where it has changed
};

/// An object's mesh and what models_info.json says of it.
struct StoreModel {
  NamedModel model;
  std::filesystem::path file;  ///< mesh file that is carried over; empty for a new object
  OrderedJson info = {};       ///< entry of models_info.json, where the file is carried over
};

/// A store with its forests and meshes, all of it in memory.
struct StoreContents {
  store::ObjectStore list;
  std::vector<GroupForest> groups;  ///< groups by number
  std::map<std::string, Mesh> meshes;
};

/// Reads all of a store. Throws InputError where a part of it cannot be read.
StoreContents read_contents(const std::filesystem::path& folder);

/// Returns the number of the group that a forest is of.
int number_of(const Forest& forest, const store::ObjectStore& list);

/// Begins a store in a folder that is there. Throws InputError where it cannot be written.
store::ObjectStore start_store(const std::filesystem::path& folder);

/// Reads the entries of models_info.json by id, with their keys in the file's order.
std::map<int, OrderedJson> read_model_entries(const store::ObjectStore& list);

/// Copies the unchanged objects of a store, all but the one of this name, into the list, the models and the images of
/// views of the new one.
void copy_objects(const StoreContents& old, const std::string& except, store::ObjectStore& new_store,
                  std::vector<StoreModel>& models);

/// Carrying of files that have not changed into a new store.
enum class Carrying {
  kLinked,  ///< link to a file of the store that it replaces, or a copy where the file system has no such links
  kCopied   ///< copy of a file of a store that stays, and may be written to
};

/// Throws InputError where it cannot be carried over.
void carry_over(const std::filesystem::path& file, const std::filesystem::path& to,
                Carrying carrying = Carrying::kLinked);

/// Writes everything but the images of views, which are there, and store.json last. Files that are carried over keep
/// every bit. All of it is read back: a store that nothing can read must not take the place of one that works.
void write_store(store::ObjectStore list, std::vector<StoreModel> models, const std::vector<GroupForest>& groups,
                 Carrying carrying = Carrying::kLinked);

}  // namespace houghstream::teach
