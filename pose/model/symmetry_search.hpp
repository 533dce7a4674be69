#pragma once

#include "pipeline/geometry/mesh.hpp"
#include "pipeline/geometry/symmetry.hpp"

namespace houghstream {

struct SymmetrySearch {
  /// A turn fits while no point of the surface ends up farther from the surface than this, in diameters: the Hausdorff
  /// distance with which BOP finds candidates (Hodan et al. 2020), which allows 0.1 and leaves the choice to people.
  /// Whatever deviates by less is no error that MSSD would see at its strictest threshold of 0.05.
  double tolerance = 0.01;
  /// Shape only, or colours too: a printed box has a shape whose symmetries its print breaks. A mesh without colours
  /// has nothing to compare.
  bool compare_colours = false;
  double colour_difference = 0.1;   ///< points differ from here on, mean of the channels, 1 = black against white
  double largest_differing = 0.05;  ///< share of the surface that may differ: sensor noise, grain, seams
};

/// The symmetries of a mesh, metres: turns about the principal axes and the box axes of its object frame, through its
/// centroid, which every symmetry keeps in place. Continuous where any angle fits, with half a turn about one
/// perpendicular axis where that fits too; two continuous axes are a ball. Else n-fold turns, n from 2 to 6, and all
/// that they combine to. Mirror images are no motions; symmetries about other axes (those of a tilted cube, whose
/// principal axes are undefined) are not found. Throws InputError for a mesh without surface.
Symmetries find_symmetries(const Mesh& mesh, const SymmetrySearch& settings = {});

}  // namespace houghstream
