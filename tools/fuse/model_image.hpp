#pragma once

#include <opencv2/core.hpp>

#include "pipeline/geometry/mesh.hpp"

namespace houghstream {

/// Draws a model (object frame, metres, z up, with normals) from four sides, a quarter turn apart and 25 degrees from
/// above, and from straight above and below: in its colours, and under them as shape alone. CV_8UC3, BGR, white
/// background.
cv::Mat draw_model(const Mesh& mesh);

}  // namespace houghstream
