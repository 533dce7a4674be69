#pragma once

#include <string>

#include "pipeline/geometry/mesh.hpp"
#include "pipeline/geometry/symmetry.hpp"

namespace houghstream::teach {

/// Checks that a mesh, in metres, can be taught. Inward faces are flipped and inward normals recomputed, with a line of
/// the log; open surfaces and inconsistently wound faces are accepted, with a line of the log. Throws InputError where
/// it is smaller or larger than what a camera sees (10 mm to 1.5 m across), naming the unit that would fit, and where
/// its middle lies farther from its origin than a store can say (store::kMaxCentre_m). `where` names the file, `unit_m`
/// the unit that it was read in.
void check_mesh(const std::string& where, double unit_m, Mesh& mesh);

/// Throws InputError naming `where` for a symmetry that takes a point of the surface farther from it than a tenth of
/// the diameter and 15 mm, which is what BOP allows a candidate (Hodan et al. 2020).
void check_symmetries(const std::string& where, const Mesh& mesh, const Symmetries& symmetries);

/// Returns false where a mesh has no colours, or one grey only, as programs write that know none.
bool has_colour(const Mesh& mesh);

}  // namespace houghstream::teach
