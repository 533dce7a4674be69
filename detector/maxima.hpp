#pragma once

#include <vector>

#include "detector/voting.hpp"
#include "pipeline/camera.hpp"

namespace houghstream {

/// Maxima of the Hough image, each moved to the nearest maximum of the votes in 3-D, those that meet merged: camera
/// frame, metres, the image's highest first.
std::vector<Eigen::Vector3f> find_maxima(const HoughSpace& space, const Camera& working_camera,
                                         const DetectionSettings& settings);

}  // namespace houghstream
