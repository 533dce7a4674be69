#pragma once

#include <vector>

#include "pipeline/geometry/mesh.hpp"
#include "pose/fusion/depth_view.hpp"

namespace houghstream::fusion {

/// Gives each vertex the mean colour of the views that see it (their depth is at most `tolerance_m` off), weighted by
/// how frontally they see it, in linear light. What the camera and the light did is taken out before: the views'
/// exposures, and where DepthView::light says that it stood still about the object, the shade on its sides (shade.hpp).
/// What no view sees takes the colour of the vertices next to it. Needs normals. Returns which vertices were seen.
/// Same arguments, same colours, for any number of threads.
std::vector<bool> colour_mesh(const std::vector<DepthView>& views, double tolerance_m, int threads, Mesh& mesh);

}  // namespace houghstream::fusion
