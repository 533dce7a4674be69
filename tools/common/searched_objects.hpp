#pragma once

#include <optional>
#include <string>

#include "drivers/store/object_store.hpp"
#include "pipeline/base/checks.hpp"
#include "tools/common/search_options.hpp"

namespace houghstream {

/// What is looked for, as a command line names it.
struct SearchedObjects {
  std::string store;  ///< of hs-teach, instead of the other two
  std::string forest;
  std::string models;
};

/// Smallest score that hs-detect reports of these objects, unless it is told otherwise.
inline float reported_from(const SearchedObjects& objects) {
  return objects.store.empty() ? EvidenceSettings{}.threshold : kStoreThreshold;
}

/// The store, where one is named: forest and models become its own, and what is reported is so from its score on,
/// unless `search` asks for another. Throws InputError where it cannot be read, or forest or models are named beside
/// it.
inline std::optional<store::ObjectStore> take_store(SearchedObjects& objects, SearchOptions& search) {
  if (objects.store.empty()) return std::nullopt;
  require(objects.forest.empty() && objects.models.empty(),
          "expected either --objects STORE or --forest FILE and --models FOLDER");
  store::ObjectStore found = store::read_store(objects.store);
  objects.forest = found.forest_file().string();
  objects.models = found.models_folder().string();
  search.threshold = search.threshold.value_or(reported_from(objects));
  return found;
}

}  // namespace houghstream
