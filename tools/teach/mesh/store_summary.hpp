#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "drivers/files/json_file.hpp"
#include "drivers/store/object_store.hpp"

namespace houghstream::teach {

/// Returns the sizes of a store's objects by id, metres, as models_info.json states them; NaN where it does not. Throws
/// InputError where that file cannot be read.
std::map<int, Eigen::Vector3d> object_sizes(const store::ObjectStore& store);

/// Returns what a teaching leaves, for a person: where the store and its contact sheet are, size and practice of each
/// object in `taught`, and the next command to type.
std::string teaching_summary(const store::ObjectStore& store, const std::set<int>& taught);

/// Returns a line for each object of the store, and below it one for its practice, one for the thresholds of this
/// precision, if one is given, and one for each of its named frames. Throws InputError for a precision outside 0 to
/// store::kMaxPrecision.
std::string store_text(const store::ObjectStore& store, std::optional<double> precision = std::nullopt);

/// Returns the list for scripts: {"store", "contact_sheet", "objects": [{"id", "name", "size_m", "group", "views",
/// "attitudes", "coloured", "shape_symmetries", "practice": {"views", "recall", "precision", "taken_for": {"name",
/// "fraction"}, "at_precision": {"wanted", "score": {"from", "precision", "recall", "reached"}, "quality": ...}},
/// "frames": {NAME: {"translation_m", "rotation"}}, "mesh"}]}; what is not known is null, and "at_precision" is there
/// where a precision is given. Throws InputError as store_text().
OrderedJson store_json(const store::ObjectStore& store, std::optional<double> precision = std::nullopt);

}  // namespace houghstream::teach
