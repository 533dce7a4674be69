#pragma once

#include <filesystem>
#include <string>

#include "drivers/store/object_store.hpp"

namespace houghstream::store {

/// Differs whenever the file has been written or exchanged, without reading it.
std::string file_stamp(const std::filesystem::path& file);

/// Returns the stamps of all files in a folder, a line each.
std::string folder_stamp(const std::filesystem::path& folder);

/// Returns the stamp of the forests of a store, of one group or several, a line each.
std::string forest_stamp(const ObjectStore& store);

/// Returns the stamp of a store's list and of all files beside its meshes, a line each.
std::string mesh_stamp(const ObjectStore& store);

}  // namespace houghstream::store
