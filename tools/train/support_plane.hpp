#pragma once

#include <optional>
#include <vector>

#include "pipeline/geometry/plane_fit.hpp"
#include "pipeline/types/training_view.hpp"

namespace houghstream {

/// Finds the plane on which a view's object stands (TrainingView::support) in the depth around its mask. Returns
/// nothing where no plane is seen there, or where the object's lowest points are not on it.
std::optional<Plane> find_support(const TrainingView& view);

/// Does so for each view of an object, and returns in how many it stands on a plane; the same for any number of
/// threads.
int find_supports(std::vector<TrainingView>& views, int threads);

}  // namespace houghstream
