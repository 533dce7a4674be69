#pragma once

#include <vector>

#include "detector/voting/voting.hpp"
#include "pipeline/types/camera.hpp"

namespace houghstream {

/// How many maxima of each of so many classes are looked at: candidates_per_class of up to four, of more so many fewer
/// that the sum stays, but at least six, so that time grows less than the number of classes.
int candidates_of_each(const DetectionSettings& settings, std::size_t classes);

/// Maxima of the Hough image, each moved to the nearest maximum of the votes in 3-D, those that meet merged: camera
/// frame, metres, the image's highest first.
std::vector<Eigen::Vector3f> find_maxima(const HoughSpace& space, const Camera& working_camera,
                                         const DetectionSettings& settings);

}  // namespace houghstream
