#pragma once

#include <set>
#include <string>
#include <vector>

#include "tools/evaluate/metrics/evaluated_frame.hpp"

// Results and truth are compared by the names of classes. Where two sides call nothing by the same name, each figure
// would be that of no object: an error, not a result.

namespace houghstream {

/// One side of a comparison: its title for people, and the names it knows.
struct NamedSide {
  std::string what;  ///< for instance "the forest out/forest"
  std::set<std::string> names;
};

/// Throws InputError naming what each side has, unless they have a name in common.
void require_shared_name(const NamedSide& a, const NamedSide& b);

/// Returns the class names of all objects in the ground truth; none for a scene without objects.
std::set<std::string> ground_truth_names(const std::vector<EvaluatedFrame>& frames);

/// Returns the class names of all detections.
std::set<std::string> detected_names(const std::vector<Detections>& results);

}  // namespace houghstream
