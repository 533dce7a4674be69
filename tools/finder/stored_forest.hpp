#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "detector/forest/forest_file.hpp"
#include "drivers/store/object_store.hpp"
#include "drivers/store/store_watcher.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/parallel.hpp"
#include "tools/finder/searched_objects.hpp"

namespace houghstream {

/// The forest of a group of an object store; its classes have the ids of the store's list. Throws InputError where it
/// cannot be read, or is not of the group's objects.
inline Forest load_group_forest(const store::ObjectStore& store, int group) {
  Forest forest = load_forest(store.forest_file(group));
  std::vector<std::string> names;
  for (const ObjectClass& object : forest.classes) names.push_back(object.name);
  store::require_same_objects(store, group, names);
  for (ObjectClass& object : forest.classes) object.class_id = store::find_object(store, object.name).id;
  return forest;
}

/// The forests of the groups that can be read, in order of their numbers, with the faults of the others; several are
/// read at once. Throws InputError where none can be read.
inline std::vector<Forest> load_whole_forests(const store::ObjectStore& store, int threads,
                                              std::vector<store::GroupFault>& faults) {
  const std::vector<int> groups = store.groups();
  std::vector<std::optional<Forest>> forests(groups.size());
  std::vector<std::string> problems(groups.size());
  parallel_for(threads, static_cast<int>(groups.size()), [&](int i) {
    const auto place = static_cast<std::size_t>(i);
    try {
      forests[place] = load_group_forest(store, groups[place]);
    } catch (const InputError& error) {
      problems[place] = error.what();
    }
  });
  std::vector<Forest> whole;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    if (forests[i]) {
      whole.push_back(*std::move(forests[i]));
    } else {
      faults.push_back({groups[i], problems[i]});
    }
  }
  if (whole.empty()) throw InputError(faults.front().problem);
  return whole;
}

/// The forests of all groups, in order of their numbers. Throws InputError naming the first that cannot be read.
inline std::vector<Forest> load_store_forests(const store::ObjectStore& store, int threads) {
  std::vector<store::GroupFault> faults;
  std::vector<Forest> forests = load_whole_forests(store, threads, faults);
  if (!faults.empty()) throw InputError(faults.front().problem);
  return forests;
}

/// The forests of the store that a command line names, or the one of its forest file.
inline std::vector<Forest> load_named_forests(const ObjectArguments& objects, int threads) {
  if (!objects.store.empty()) return load_store_forests(store::read_store(objects.store), threads);
  std::vector<Forest> forests;
  forests.push_back(load_forest(objects.forest));
  return forests;
}

}  // namespace houghstream
