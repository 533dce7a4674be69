#pragma once

#include <array>
#include <vector>

#include "detector/voting/hough_space.hpp"
#include "pipeline/types/camera.hpp"

namespace houghstream {

/// Range of HoughSpace::votes from `begin` on, up to but not including `end`.
struct VoteRange {
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
};

/// Lists the votes within `radius_cells` of a cell, row by row. `ranges` is overwritten.
void ranges_of_cells(const HoughSpace& space, int cell_x, int cell_y, int radius_cells, std::vector<VoteRange>& ranges);

/// Lists the ranges of all votes within reach of a centre (camera frame, metres), and of some beyond it.
void ranges_in_reach(const HoughSpace& space, const Camera& camera, const Eigen::Vector3f& centre, float vote_sigma,
                     std::vector<VoteRange>& ranges);

constexpr std::size_t kSumLanes = 8;  ///< partial sums: the order of a sum is its rounding
using SumLanes = std::array<std::array<float, kSumLanes>, 4>;
static_assert(kVotePadding == kSumLanes - 1);

/// Sums over votes: of their kernel weights, and of their centres times these. The quotient is the mean shift.
struct VoteSupport {
  Eigen::Vector3f moment = Eigen::Vector3f::Zero();
  float total = 0.0F;
};

/// Returns the support of `centre` by the votes in the ranges. Many votes are summed at once, in an order that is the
/// same on every machine: vote v of a range adds to partial sum v % kSumLanes of each coordinate, and these are added
/// in pairs, pairs of pairs, and so on.
VoteSupport sum_support(const HoughSpace& space, const std::vector<VoteRange>& ranges, const Eigen::Vector3f& centre,
                        float vote_sigma);

/// Moves a centre to the nearest maximum of the votes (mean shift, Comaniciu & Meer 2002). `ranges` is overwritten.
Eigen::Vector3f seek_mode(const HoughSpace& space, const Camera& camera, Eigen::Vector3f centre, float vote_sigma,
                          std::vector<VoteRange>& ranges);

}  // namespace houghstream
