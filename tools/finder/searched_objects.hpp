#pragma once

#include <optional>
#include <string>
#include <vector>

#include "drivers/store/object_store.hpp"
#include "pipeline/base/checks.hpp"

namespace houghstream {

/// Objects to search for, as a command line names them.
struct ObjectArguments {
  std::string store;  ///< of hs-teach, instead of the other two
  std::string forest;
  std::string models;
};

/// The store, where one is named: forest (of several groups their folder) and models become its own. Throws InputError
/// where it cannot be read, or forest or models are named beside it.
inline std::optional<store::ObjectStore> resolve_store(ObjectArguments& objects) {
  if (objects.store.empty()) return std::nullopt;
  require(objects.forest.empty() && objects.models.empty(),
          "expected either --objects STORE or --forest FILE and --models FOLDER");
  store::ObjectStore found = store::read_store(objects.store);
  const std::vector<int> groups = found.groups();
  objects.forest = (groups.size() == 1 ? found.forest_file(groups.front()) : found.forests_folder()).string();
  objects.models = found.models_folder().string();
  return found;
}

}  // namespace houghstream
