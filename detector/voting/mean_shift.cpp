// Compiled once for each instruction set, see foreach_target.h of Highway.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detector/voting/mean_shift.cpp"
#include "detector/voting/mean_shift.hpp"

#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace houghstream::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Float = hn::CappedTag<float, kSumLanes>;
using Floats = hn::Vec<Float>;

constexpr std::size_t kVectors = kSumLanes / hn::MaxLanes(Float());

struct Sums {
  Floats x, y, z, total;
};

/// Adds one vector of votes, of which the first `count` matter.
HWY_INLINE void add_votes(const float* votes, std::size_t count, const Sums& centre, Floats reach_sq, Sums& sums) {
  const Float d;
  Floats x, y, z, weight;
  hn::LoadInterleaved4(d, votes, x, y, z, weight);
  const Floats dx = hn::Sub(x, centre.x);
  const Floats dy = hn::Sub(y, centre.y);
  const Floats dz = hn::Sub(z, centre.z);
  const Floats distance_sq = hn::Add(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)), hn::Mul(dz, dz));
  const Floats q = hn::Max(hn::Sub(hn::Set(d, 1.0F), hn::Div(distance_sq, reach_sq)), hn::Zero(d));
  const Floats k = hn::IfThenElseZero(hn::FirstN(d, count), hn::Mul(hn::Mul(q, q), weight));
  sums.x = hn::Add(sums.x, hn::Mul(k, x));
  sums.y = hn::Add(sums.y, hn::Mul(k, y));
  sums.z = hn::Add(sums.z, hn::Mul(k, z));
  sums.total = hn::Add(sums.total, k);
}

/// Writes the partial sums of x, y, z and the support into `lanes`.
void sum_lanes(const Vote* votes, const std::vector<VoteRange>& ranges, const Eigen::Vector3f& centre, float reach_sq,
               SumLanes& lanes) {
  const Float d;
  constexpr std::size_t kLanes = hn::MaxLanes(Float());
  const Sums at = {hn::Set(d, centre.x()), hn::Set(d, centre.y()), hn::Set(d, centre.z()), hn::Zero(d)};
  const Floats reach = hn::Set(d, reach_sq);
  Sums sums[kVectors];
  for (Sums& s : sums) s = {hn::Zero(d), hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  for (const VoteRange& range : ranges) {
    for (std::size_t v = range.begin; v < range.end; v += kSumLanes) {
      const std::size_t left = range.end - v;
      for (std::size_t i = 0; i < kVectors; ++i) {
        const std::size_t count = left > i * kLanes ? left - i * kLanes : 0;
        add_votes(votes[v + i * kLanes].centre_camera.data(), count, at, reach, sums[i]);
      }
    }
  }
  for (std::size_t i = 0; i < kVectors; ++i) {
    hn::StoreU(sums[i].x, d, lanes[0].data() + i * kLanes);
    hn::StoreU(sums[i].y, d, lanes[1].data() + i * kLanes);
    hn::StoreU(sums[i].z, d, lanes[2].data() + i * kLanes);
    hn::StoreU(sums[i].total, d, lanes[3].data() + i * kLanes);
  }
}

}  // namespace houghstream::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace houghstream {
namespace {

HWY_EXPORT(sum_lanes);

/// Sums pairs, then pairs of pairs, and so on.
float sum_of(const std::array<float, kSumLanes>& l) {
  return ((l[0] + l[1]) + (l[2] + l[3])) + ((l[4] + l[5]) + (l[6] + l[7]));
}

VoteSupport support_of(const SumLanes& lanes) {
  return {{sum_of(lanes[0]), sum_of(lanes[1]), sum_of(lanes[2])}, sum_of(lanes[3])};
}

float reach_sq_of(float vote_sigma) {
  return (kVoteReach * vote_sigma) * (kVoteReach * vote_sigma);
}

}  // namespace

void ranges_of_cells(const HoughSpace& space, int cell_x, int cell_y, int radius_cells,
                     std::vector<VoteRange>& ranges) {
  ranges.clear();
  const int x0 = std::max(0, cell_x - radius_cells);
  const int x1 = std::min(space.width - 1, cell_x + radius_cells);
  if (x0 > x1) return;
  for (int y = std::max(0, cell_y - radius_cells); y <= std::min(space.height - 1, cell_y + radius_cells); ++y) {
    ranges.push_back({space.first_vote[static_cast<std::size_t>(y * space.width + x0)],
                      space.first_vote[static_cast<std::size_t>(y * space.width + x1) + 1]});
  }
}

void ranges_in_reach(const HoughSpace& space, const Camera& camera, const Eigen::Vector3f& centre, float vote_sigma,
                     std::vector<VoteRange>& ranges) {
  const Eigen::Vector2d px = camera.project(centre.cast<double>());
  const int x = static_cast<int>(std::floor((px.x() + 0.5) / space.cell_px));
  const int y = static_cast<int>(std::floor((px.y() + 0.5) / space.cell_px));
  const double reach_px = kVoteReach * vote_sigma / camera.metres_per_px(centre.z());
  ranges_of_cells(space, x, y, static_cast<int>(reach_px / space.cell_px) + 1, ranges);
}

VoteSupport sum_support(const HoughSpace& space, const std::vector<VoteRange>& ranges, const Eigen::Vector3f& centre,
                        float vote_sigma) {
  SumLanes lanes;
  HWY_DYNAMIC_DISPATCH(sum_lanes)
  (space.votes.data(), ranges, centre, reach_sq_of(vote_sigma), lanes);
  return support_of(lanes);
}

Eigen::Vector3f seek_mode(const HoughSpace& space, const Camera& camera, Eigen::Vector3f centre, float vote_sigma,
                          std::vector<VoteRange>& ranges) {
  constexpr int kSteps = 8;
  constexpr float kConverged_m = 0.0005F;
  for (int step = 0; step < kSteps; ++step) {
    ranges_in_reach(space, camera, centre, vote_sigma, ranges);
    const VoteSupport support = sum_support(space, ranges, centre, vote_sigma);
    if (support.total <= 0.0F) break;
    const Eigen::Vector3f next = support.moment / support.total;
    const bool has_converged = (next - centre).norm() < kConverged_m;
    centre = next;
    if (has_converged) break;
  }
  return centre;
}

}  // namespace houghstream
#endif
