#pragma once

#include <map>
#include <string>

#include "pipeline/geometry/mesh.hpp"

namespace houghstream {

/// Returns why a mesh that is so large, read in units of `unit_m`, is no object that a camera sees whole (10 mm to 1.5
/// m across), with the values of the option `unit` that would make it one. Empty where it is one.
std::string mesh_size_error(double size_m, double unit_m, const std::string& unit);

/// Checks models by name, by the diagonals of their boxes, which are quickly known; one line for all.
std::string fault_of_sizes(const std::map<std::string, Mesh>& models, double unit_m, const std::string& unit);

}  // namespace houghstream
