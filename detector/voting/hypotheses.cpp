#include "detector/voting/hypotheses.hpp"

#include <hwy/base.h>
#include <hwy/cache_control.h>

#include <algorithm>

#include "detector/voting/mean_shift.hpp"

namespace houghstream {
namespace {

/// Sums the support of a maximum by voter, into own.by_voter; returns the number of votes.
int sum_by_voter(const Camera& camera, const Eigen::Vector3f& centre, float vote_sigma, VotingMemory::Worker& own) {
  const HoughSpace& space = own.space;
  SparseSums::Weights& supports = own.supports;
  own.voter_sums.make_room(space.voters.size());
  ranges_around(space, camera, centre, vote_sigma, own.ranges);
  int count = 0;
  for (const VoteRange& range : own.ranges) {
    supports.resize(std::max<std::size_t>(supports.size(), range.end - range.begin + 1));
    std::size_t found = 0;
    for (std::uint32_t v = range.begin; v < range.end; ++v) {  // without a branch that nobody can predict
      const Vote& vote = space.votes[v];
      const float k = vote_kernel((vote.centre_camera - centre).squaredNorm(), vote_sigma);
      supports[found] = {v, k * vote.weight};
      found += k > 0.0F ? 1 : 0;
    }
    for (std::size_t i = 0; i < found; ++i) own.voter_sums.add(space.voter[supports[i].first], supports[i].second);
    count += static_cast<int>(found);
  }
  own.voter_sums.take(own.by_voter);
  return count;
}

/// Sums the support in own.by_voter by remembered view, heaviest first.
void sum_by_view(const Forest& forest, VotingMemory::Worker& own, SparseSums::Weights& by_view) {
  constexpr std::size_t kAhead = 8;  // voters, so that their cache misses overlap
  const SparseSums::Weights& by_voter = own.by_voter;
  const auto class_of = [&](std::size_t s) {
    return &forest.leaf_classes[own.space.voters[by_voter[s].first].leaf_class];
  };
  own.view_sums.make_room(forest.views.size());
  for (std::size_t i = 0; i < by_voter.size(); ++i) {
    if (i + 2 * kAhead < by_voter.size()) {
      hwy::Prefetch(class_of(i + 2 * kAhead));
      hwy::Prefetch(forest.leaf_views.data() + class_of(i + kAhead)->first_view);
      hwy::Prefetch(forest.leaf_views.data() + class_of(i + kAhead)->first_view + 8);
    }
    const LeafClass& entry = *class_of(i);
    for (std::uint32_t v = entry.first_view; v < entry.first_view + entry.view_count; ++v) {
      own.view_sums.add(forest.leaf_views[v].view, by_voter[i].second * forest.leaf_views[v].weight);
    }
  }
  own.view_sums.take(by_view);
  // ties by index, as a stable sort would leave them, which takes memory for each maximum
  std::sort(by_view.begin(), by_view.end(), [](const auto& a, const auto& b) {
    return a.second > b.second || (a.second == b.second && a.first < b.first);
  });
}

/// A maximum with what supports it; its mass is what is seen of the object, the weight times the area of the patches.
/// One without `least_mass` is left without either.
Hypothesis gather_support(const VotingInput& input, const Eigen::Vector3f& centre, float least_mass,
                          VotingMemory::Worker& own) {
  own.by_patch.clear();
  Hypothesis hypothesis;
  hypothesis.centre_camera = centre;
  hypothesis.vote_count = sum_by_voter(input.camera, centre, input.settings.vote_sigma, own);
  for (const auto& [index, weight] : own.by_voter) {
    const std::uint32_t patch = own.space.voters[index].patch;
    hypothesis.weight += weight;
    hypothesis.mass += weight * input.patches.area[patch];
    if (own.by_patch.empty() || own.by_patch.back().first != patch) own.by_patch.emplace_back(patch, 0.0F);
    own.by_patch.back().second += weight;
  }
  if (hypothesis.mass < least_mass) return hypothesis;
  hypothesis.patches = own.by_patch;
  sum_by_view(input.forest, own, hypothesis.views);
  return hypothesis;
}

/// The classes, those with the most to do first, so that no thread starts with one when the others have ended.
std::vector<std::size_t> by_work(std::size_t classes, const PatchPosteriors& posteriors) {
  std::vector<std::size_t> work(classes, 0);
  std::vector<std::size_t> order(classes);
  for (std::size_t c = 0; c < classes; ++c) {
    order[c] = c;
    posteriors.for_supporters(static_cast<int>(c),
                              [&](std::uint32_t, const std::uint32_t*, std::uint32_t count) { work[c] += count; });
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return work[a] > work[b]; });
  return order;
}

}  // namespace

void SparseSums::make_room(std::size_t count) {
  if (sums_.size() >= count) return;
  sums_.resize(count, 0.0F);
  touched_.resize(count / kBits + 1, 0);
}

void SparseSums::take(Weights& out) {
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

std::vector<Hypothesis> class_hypotheses(const VotingInput& input, std::size_t class_index, float least_mass, int limit,
                                         VotingMemory::Worker& own) {
  const std::vector<Eigen::Vector3f> maxima = find_maxima(own.space, input.camera, input.settings, limit, own.maxima);
  std::vector<Hypothesis> hypotheses;
  hypotheses.reserve(maxima.size());
  for (const Eigen::Vector3f& centre : maxima) {
    Hypothesis hypothesis = gather_support(input, centre, least_mass, own);
    hypothesis.class_index = class_index;
    if (hypothesis.mass >= least_mass) hypotheses.push_back(std::move(hypothesis));
  }
  std::stable_sort(hypotheses.begin(), hypotheses.end(),
                   [](const Hypothesis& a, const Hypothesis& b) { return a.mass > b.mass; });
  return hypotheses;
}

std::vector<Hypothesis> find_hypotheses(const VotingInput& input, int threads, VotingMemory& memory) {
  const std::vector<ObjectClass>& classes = input.forest.classes;
  const std::vector<std::size_t> order = by_work(classes.size(), input.posteriors);
  const int limit = each_of(classes.size(), input.settings.maxima_per_class);
  const auto most = static_cast<std::size_t>(each_of(classes.size(), input.settings.candidates_per_class));
  std::vector<std::vector<Hypothesis>> by_class(classes.size());
  memory.workers.make_room(threads);
  parallel_for_workers(threads, static_cast<int>(order.size()), [&](int worker, int i) {
    const std::size_t c = order[static_cast<std::size_t>(i)];
    VotingMemory::Worker& own = memory.workers[worker];
    cast_votes(input, static_cast<int>(c), own.casting, own.space);
    const float least_mass = input.settings.min_mass_share * classes[c].expected_mass;
    by_class[c] = class_hypotheses(input, c, least_mass, limit, own);
    if (by_class[c].size() > most) by_class[c].resize(most);
  });
  std::vector<Hypothesis> all;
  std::size_t count = 0;
  for (const std::vector<Hypothesis>& own : by_class) count += own.size();
  all.reserve(count);
  for (std::vector<Hypothesis>& own : by_class) std::move(own.begin(), own.end(), std::back_inserter(all));
  return all;
}

}  // namespace houghstream
