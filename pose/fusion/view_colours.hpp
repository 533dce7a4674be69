#pragma once

#include <vector>

#include "pipeline/geometry/mesh.hpp"
#include "pose/fusion/depth_view.hpp"

namespace houghstream::fusion {

/// Gives each vertex the mean colour of the views that see it (their depth is at most `tolerance_m` off), weighted by
/// how frontally they see it, in linear light. The effects of camera and lighting are removed before: the views'
/// exposures, and for views with a DepthView::lighting_id, whose lighting was static relative to the object, the
/// shading on its sides (view_shading.hpp). Unobserved vertices take the colour of the vertices next to them. It needs
/// normals. Returns which vertices were observed. The same arguments give the same colours, for any number of threads.
std::vector<bool> colour_mesh(const std::vector<DepthView>& views, double tolerance_m, int threads, Mesh& mesh);

}  // namespace houghstream::fusion
