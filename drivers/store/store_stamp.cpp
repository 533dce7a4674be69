#include "drivers/store/store_stamp.hpp"

#include <fmt/ranges.h>
#include <sys/stat.h>

#include <algorithm>
#include <vector>

namespace houghstream::store {

namespace fs = std::filesystem;

std::string file_stamp(const fs::path& file) {
  struct stat is {};
  if (stat(file.c_str(), &is) != 0) return file.string() + " missing";
  return fmt::format("{} {} {} {} {}.{} {}.{}", file.string(), is.st_dev, is.st_ino, is.st_size, is.st_mtim.tv_sec,
                     is.st_mtim.tv_nsec, is.st_ctim.tv_sec, is.st_ctim.tv_nsec);
}

std::string folder_stamp(const fs::path& folder) {
  std::vector<std::string> states;
  std::error_code error;  // a folder that goes away meanwhile shows in the next state
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    states.push_back(file_stamp(entry->path()));
  std::sort(states.begin(), states.end());
  return fmt::format("{}", fmt::join(states, "\n"));
}

std::string forest_stamp(const ObjectStore& store) {
  ObjectStore of_one_group;
  of_one_group.folder = store.folder;
  return fmt::format("{}\n{}", file_stamp(of_one_group.forest_file(0)), folder_stamp(store.forests_folder()));
}

std::string mesh_stamp(const ObjectStore& store) {
  return fmt::format("{}\n{}", file_stamp(store.json_file()), folder_stamp(store.models_folder()));
}

}  // namespace houghstream::store
