#pragma once

#include <string>
#include <utility>
#include <vector>

#include "drivers/store/object_store.hpp"
#include "pipeline/geometry/mesh.hpp"

namespace houghstream::teach {

/// Two objects that look alike from some side.
struct Lookalike {
  std::string one;
  std::string other;
  bool mirrored = false;  ///< only a mirror image of the one is like the other
  double scale = 1.0;     ///< the other's size over the one's
};

/// A mesh by its object's name.
using NamedMesh = std::pair<std::string, const Mesh*>;

/// Returns all pairs whose shapes and colours agree after a turn, a reflection, and a change of size by at most a
/// quarter. The centroids and principal axes of evenly spread surface points are laid on each other in every way, and
/// turned about each of them in steps of 10 degrees, since principal axes of what is round or square are arbitrary;
/// distances are those to the other's surface. Colours agree also where one of the two has none. Throws InputError for
/// a mesh without surface.
std::vector<Lookalike> find_lookalikes(const std::vector<NamedMesh>& meshes);

/// Returns one line that says so.
std::string describe(const Lookalike& pair);

/// Returns a line for each two objects of a store of which one was detected in the place of the other too often in
/// practice (store::PracticeRecord::taken_for), in the order of their ids.
std::vector<std::string> confusion_lines(const store::ObjectStore& store);

}  // namespace houghstream::teach
