#pragma once

#include <utility>
#include <vector>

#include "detector/voting/hough_space.hpp"
#include "detector/voting/mean_shift.hpp"

namespace houghstream {

/// How many of each of so many classes are looked at: `per_class` of up to four, of more so many fewer that the sum
/// stays, but at least six, so that time grows less than the number of classes.
int per_class_budget(std::size_t classes, int per_class);

/// A local maximum of the Hough image.
struct HoughCell {
  int x = 0;
  int y = 0;
  float value = 0.0F;
};

/// What find_maxima needs for itself, to be kept from class to class.
struct MaximaWorkspace {
  std::vector<HoughCell> cells;
  std::vector<VoteRange> ranges;
  std::vector<std::pair<float, float>> depths;  ///< and weights
};

/// Maxima of the Hough image, at most `limit`, each moved to the nearest maximum of the votes in 3-D, those that meet
/// merged: camera frame, metres, the image's highest first.
std::vector<Eigen::Vector3f> find_maxima(const HoughSpace& space, const Camera& camera, const VotingSettings& settings,
                                         int limit, MaximaWorkspace& workspace);

}  // namespace houghstream
