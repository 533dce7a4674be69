#include "detector/voting/hypotheses.hpp"

#include <hwy/base.h>
#include <hwy/cache_control.h>

#include <algorithm>
#include <utility>

#include "detector/voting/maxima.hpp"
#include "detector/voting/mean_shift.hpp"

namespace houghstream {
namespace {

using Weights = std::vector<std::pair<std::uint32_t, float>>;

/// Sums by index that are 0 where nothing was added, kept so from use to use.
class SparseSums {
 public:
  void make_room(std::size_t count) {
    if (sums_.size() >= count) return;
    sums_.resize(count, 0.0F);
    touched_.resize(count / kBits + 1, 0);
  }

  void add(std::uint32_t index, float value) {
    touched_[index / kBits] |= std::uint64_t{1} << index % kBits;
    sums_[index] += value;
  }

  /// Indices and sums in order of the index; forgets them.
  void take(Weights& out) {
    out.clear();
    std::size_t count = 0;
    for (const std::uint64_t bits : touched_) count += hwy::PopCount(bits);
    out.reserve(count);
    for (std::size_t word = 0; word < touched_.size(); ++word) {
      for (std::uint64_t bits = touched_[word]; bits != 0; bits &= bits - 1) {
        const auto index = static_cast<std::uint32_t>(word * kBits + hwy::Num0BitsBelowLS1Bit_Nonzero64(bits));
        out.emplace_back(index, sums_[index]);
        sums_[index] = 0.0F;
      }
      touched_[word] = 0;
    }
  }

 private:
  static constexpr std::size_t kBits = 64;
  std::vector<float> sums_;
  std::vector<std::uint64_t> touched_;  // a bit for each sum, so that they need no sorting
};

/// Sums the support of a maximum by voter; returns the number of votes.
int sum_by_voter(const HoughSpace& space, const Camera& camera, const Eigen::Vector3f& centre, float vote_sigma,
                 Weights& by_voter) {
  static thread_local std::vector<VoteRange> ranges;  // these three are kept from maximum to maximum
  static thread_local Weights supports;
  static thread_local SparseSums sums;
  sums.make_room(space.voters.size());
  ranges_around(space, camera, centre, vote_sigma, ranges);
  int count = 0;
  for (const VoteRange& range : ranges) {
    supports.resize(std::max<std::size_t>(supports.size(), range.end - range.begin + 1));
    std::size_t found = 0;
    for (std::uint32_t v = range.begin; v < range.end; ++v) {  // without a branch that nobody can predict
      const Vote& vote = space.votes[v];
      const float k = vote_kernel((vote.centre_camera - centre).squaredNorm(), vote_sigma);
      supports[found] = {v, k * vote.weight};
      found += k > 0.0F ? 1 : 0;
    }
    for (std::size_t i = 0; i < found; ++i) sums.add(space.voter[supports[i].first], supports[i].second);
    count += static_cast<int>(found);
  }
  sums.take(by_voter);
  return count;
}

/// Sums the support by remembered view, heaviest first.
void sum_by_view(const Forest& forest, const HoughSpace& space, const Weights& by_voter, Weights& by_view) {
  constexpr std::size_t kAhead = 8;  // voters, so that their cache misses overlap
  static thread_local SparseSums sums;
  sums.make_room(forest.views.size());
  for (std::size_t i = 0; i < by_voter.size(); ++i) {
    if (i + 2 * kAhead < by_voter.size()) {
      const auto class_of = [&](std::size_t s) {
        return &forest.leaf_classes[space.voters[by_voter[s].first].leaf_class];
      };
      hwy::Prefetch(class_of(i + 2 * kAhead));
      hwy::Prefetch(forest.leaf_views.data() + class_of(i + kAhead)->first_view);
      hwy::Prefetch(forest.leaf_views.data() + class_of(i + kAhead)->first_view + 8);
    }
    const LeafClass& entry = forest.leaf_classes[space.voters[by_voter[i].first].leaf_class];
    for (std::uint32_t v = entry.first_view; v < entry.first_view + entry.view_count; ++v) {
      sums.add(forest.leaf_views[v].view, by_voter[i].second * forest.leaf_views[v].weight);
    }
  }
  sums.take(by_view);
  // ties by index, as a stable sort would leave them, which takes memory for each maximum
  std::sort(by_view.begin(), by_view.end(), [](const auto& a, const auto& b) {
    return a.second > b.second || (a.second == b.second && a.first < b.first);
  });
}

/// A maximum with what supports it; its mass is what is seen of the object, the weight times the area of the patches.
/// One without `least_mass` is left without either.
Hypothesis gather_support(const Forest& forest, const HoughSpace& space, const PatchGrid& patches, const Camera& camera,
                          const Eigen::Vector3f& centre, float least_mass, float vote_sigma) {
  static thread_local Weights by_voter;  // both kept from maximum to maximum
  static thread_local Weights supporters;
  supporters.clear();
  Hypothesis hypothesis;
  hypothesis.centre_camera = centre;
  hypothesis.vote_count = sum_by_voter(space, camera, centre, vote_sigma, by_voter);
  for (const auto& [index, weight] : by_voter) {
    const std::uint32_t patch = space.voters[index].patch;
    hypothesis.weight += weight;
    hypothesis.mass += weight * patches.area[patch];
    if (supporters.empty() || supporters.back().first != patch) supporters.emplace_back(patch, 0.0F);
    supporters.back().second += weight;
  }
  if (hypothesis.mass < least_mass) return hypothesis;
  hypothesis.patches = supporters;
  sum_by_view(forest, space, by_voter, hypothesis.views);
  return hypothesis;
}

}  // namespace

std::vector<Hypothesis> find_hypotheses(const Forest& forest, const HoughSpace& space, const PatchGrid& patches,
                                        const Camera& working_camera, float least_mass,
                                        const DetectionSettings& settings) {
  const std::vector<Eigen::Vector3f> maxima = find_maxima(space, working_camera, settings);
  std::vector<Hypothesis> hypotheses;
  hypotheses.reserve(maxima.size());
  for (const Eigen::Vector3f& centre : maxima) {
    Hypothesis hypothesis =
        gather_support(forest, space, patches, working_camera, centre, least_mass, settings.vote_sigma);
    if (hypothesis.mass >= least_mass) hypotheses.push_back(std::move(hypothesis));
  }
  std::stable_sort(hypotheses.begin(), hypotheses.end(),
                   [](const Hypothesis& a, const Hypothesis& b) { return a.mass > b.mass; });
  return hypotheses;
}

}  // namespace houghstream
