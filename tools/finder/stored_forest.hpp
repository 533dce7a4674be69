#pragma once

#include <string>
#include <vector>

#include "detector/forest/forest_file.hpp"
#include "drivers/store/object_store.hpp"

namespace houghstream {

/// The forest of an object store. Throws InputError where it cannot be read, or is not of the objects in the store's
/// list.
inline Forest load_store_forest(const store::ObjectStore& store) {
  Forest forest = load_forest(store.forest_file());
  std::vector<std::string> names;
  for (const ObjectClass& object : forest.classes) names.push_back(object.name);
  store::require_same_objects(store, names);
  return forest;
}

}  // namespace houghstream
