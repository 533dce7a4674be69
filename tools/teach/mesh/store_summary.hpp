#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <set>
#include <string>

#include "drivers/files/json_file.hpp"
#include "drivers/store/object_store.hpp"
#include "tools/teach/mesh/score_calibration.hpp"

namespace houghstream::teach {

/// Returns the sizes of a store's objects by id, metres, as models_info.json states them; NaN where it does not. Throws
/// InputError where that file cannot be read.
std::map<int, Eigen::Vector3d> object_sizes(const store::ObjectStore& store);

/// Returns what a teaching leaves, for a person: where the store and its contact sheet are, size and practice of each
/// object in `taught`, and the next command to type.
std::string teaching_summary(const store::ObjectStore& store, const std::set<int>& taught,
                             const std::map<std::string, PracticeCount>& practice);

/// Returns a line for each object of the store, and below it one for each of its named frames.
std::string store_text(const store::ObjectStore& store);

/// Returns the list for scripts: {"store", "contact_sheet", "objects": [{"id", "name", "size_m", "group", "views",
/// "attitudes", "coloured", "shape_symmetries", "frames": {NAME: {"translation_m", "rotation"}}, "mesh"}]}; what is not
/// known is null.
OrderedJson store_json(const store::ObjectStore& store);

}  // namespace houghstream::teach
