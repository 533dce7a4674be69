#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "pose/model/object_model.hpp"

namespace houghstream {

/// Caches the models made of the meshes of a store, or of a folder of models, in their memory layout for the next
/// start: a restart then takes a third of the time. Only the program that made the cache reads it, and only for the
/// same files: with any file that has been written, exchanged or installed since, the models are made again.
class ModelCache {
 public:
  /// `folder` holds one file for each of a few model folders; empty = no cache. It must be made first in the program:
  /// the libraries linked with it count as part of it, but not those that they load later.
  explicit ModelCache(std::filesystem::path folder);

  /// Returns the cache key: `stamp`, which changes with the files (store_stamp.hpp), the state of this program and its
  /// libraries, and the settings. No file is read.
  std::string state_of(const std::string& stamp, const ModelSettings& settings) const;

  /// Loads the models cached of the folder under this key. Returns nothing where there are none, somebody else could
  /// have written them, or they are damaged.
  std::optional<std::map<std::string, ObjectModel>> find(const std::filesystem::path& folder,
                                                         const std::string& state) const;

  /// Saves the models. Where they cannot be stored, as in a read-only folder, it does nothing.
  void keep(const std::filesystem::path& folder, const std::string& state,
            const std::map<std::string, ObjectModel>& models) const;

 private:
  std::filesystem::path file_of(const std::filesystem::path& folder) const;

  std::filesystem::path folder_;
  std::string program_;  // its state, and its libraries'
};

}  // namespace houghstream
