#pragma once

#include <string>

#include "drivers/files/json_file.hpp"
#include "pipeline/geometry/symmetry.hpp"

namespace houghstream {

/// Reads the symmetries of an entry of models_info.json: symmetries_discrete, each the 16 numbers of a row-wise 4x4
/// matrix with its translation in millimetres, and symmetries_continuous, each {axis, offset} with the offset in
/// millimetres (bop_toolkit, docs/bop_datasets_format.md). Returns none where it lists none; axes are returned at unit
/// length. Throws InputError naming `where` (file and object) for a matrix that is no rigid motion and an axis of
/// length 0.
Symmetries symmetries_from_json(const nlohmann::json& entry, const std::string& where);

/// Adds the keys for those that there are.
void add_symmetries(const Symmetries& symmetries, OrderedJson& entry);

/// Reads an axis in the form of symmetries_continuous. Throws InputError naming `where` and `key` where it is invalid.
ContinuousSymmetry axis_from_json(const nlohmann::json& entry, const std::string& key, const std::string& where);
OrderedJson axis_to_json(const ContinuousSymmetry& symmetry);

}  // namespace houghstream
