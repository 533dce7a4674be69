#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "pose/model/object_model.hpp"

namespace houghstream {

/// What has been made of the meshes of a store, or of a folder of models, kept as it lies in memory for the next start:
/// who was killed is back in a third of the time. It is used by the very program that made it only, of the very files:
/// whatever has been written, exchanged or installed since is another state, and the models are made anew.
class ModelCache {
 public:
  /// `folder`: where they are kept, a file for each of a few folders. Empty = nowhere. To be made before anything else:
  /// the libraries that the program was linked with count as its own, not those that they load as they go.
  explicit ModelCache(std::filesystem::path folder);

  /// All that models are made of: `stamp`, which tells whether the files have changed (store_stamp.hpp), the state of
  /// this program and its libraries, and the settings. Nothing is read.
  std::string state_of(const std::string& stamp, const ModelSettings& settings) const;

  /// Those that were kept of the folder in this state. Nothing where there are none, somebody else could have written
  /// them, or they are damaged.
  std::optional<std::map<std::string, ObjectModel>> find(const std::filesystem::path& folder,
                                                         const std::string& state) const;

  /// Where they cannot be kept, as in a folder that is read only, nothing is.
  void keep(const std::filesystem::path& folder, const std::string& state,
            const std::map<std::string, ObjectModel>& models) const;

 private:
  std::filesystem::path file_of(const std::filesystem::path& folder) const;

  std::filesystem::path folder_;
  std::string program_;  // its state, and its libraries'
};

}  // namespace houghstream
