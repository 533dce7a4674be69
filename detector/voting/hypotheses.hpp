#pragma once

#include <vector>

#include "detector/voting/voting.hpp"

namespace houghstream {

/// A maximum of the 3-D vote density of one class, with everything that supports it.
struct Hypothesis {
  Eigen::Vector3f centre_camera = Eigen::Vector3f::Zero();  ///< metres
  float mass = 0.0F;    ///< votes' weight times the area of their patches, square metres: what is seen of the object
  float weight = 0.0F;  ///< votes' weight
  int vote_count = 0;
  std::vector<std::pair<std::uint32_t, float>> patches;  ///< supporting patch and its weight, by patch
  std::vector<std::pair<std::uint32_t, float>> views;    ///< remembered training view and its weight, heaviest first
};

/// The maxima of a class's votes with at least `least_mass`, strongest first.
std::vector<Hypothesis> find_hypotheses(const Forest& forest, const HoughSpace& space, const PatchGrid& patches,
                                        const Camera& working_camera, float least_mass,
                                        const DetectionSettings& settings);

}  // namespace houghstream
