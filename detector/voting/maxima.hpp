#pragma once

#include <utility>
#include <vector>

#include "detector/voting/hough_space.hpp"
#include "detector/voting/mean_shift.hpp"

namespace houghstream {

/// Returns the number of maxima that are scored for each class: `per_class` for up to four classes, fewer for more
/// classes so that their sum stays, but at least six. Time thereby grows less than the number of classes. (In 88 images
/// of furnished rooms an object's maximum was among the six heaviest of its class 265 times of 266, and always among
/// the eight heaviest.)
int per_class_budget(std::size_t classes, int per_class);

/// A local maximum of the Hough image.
struct HoughCell {
  int x = 0;
  int y = 0;
  float value = 0.0F;
};

/// Workspace of find_maxima(), reused from class to class.
struct MaximaWorkspace {
  std::vector<HoughCell> cells;
  std::vector<VoteRange> ranges;
  std::vector<std::pair<float, float>> depths;  ///< depths and their weights
};

/// Returns at most `limit` maxima of the Hough image, each moved to the nearest maximum of the votes in 3-D, camera
/// frame, metres, the image's highest first. Of maxima that move to the same place the first is kept.
std::vector<Eigen::Vector3f> find_maxima(const HoughSpace& space, const Camera& camera, const VotingSettings& settings,
                                         int limit, MaximaWorkspace& workspace);

}  // namespace houghstream
