#pragma once

#include <optional>

#include "pose/seen/depth_score.hpp"
#include "pose/seen/region.hpp"
#include "pose/seen/surface_foreground.hpp"

namespace houghstream {

/// Finds the plane in the observed region, the plane's colours at the region's edge, and what differs from them and is
/// no higher above the plane than the model is thick. Returns nothing where less than half of the region is one plane,
/// or where nothing differs.
std::optional<SurfaceForeground> find_surface_foreground(const ObjectObservation& observation);

/// Returns the mean evidence of a view's points, -1 to 1; points beside the observed region count -1.
float mean_evidence(const SurfaceForeground& foreground, const ProjectedView& projected);

}  // namespace houghstream
