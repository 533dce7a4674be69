#include "detector/voting/hypotheses.hpp"

#include <hwy/base.h>
#include <hwy/cache_control.h>

#include <algorithm>

#include "detector/voting/mean_shift.hpp"

namespace houghstream {
namespace {

/// Sums the support of a maximum by voter; returns the number of votes.
int sum_by_voter(const VotingInput& input, const Eigen::Vector3f& centre, VotingWorkspace::Worker& workspace,
                 SparseSums::Weights& by_voter) {
  const HoughSpace& space = workspace.space;
  const float vote_sigma = input.settings.vote_sigma;
  SparseSums::Weights& supports = workspace.supports;
  workspace.voter_sums.resize(space.voters.size());
  ranges_in_reach(space, input.camera, centre, vote_sigma, workspace.ranges);
  int count = 0;
  for (const VoteRange& range : workspace.ranges) {
    supports.resize(std::max<std::size_t>(supports.size(), range.end - range.begin + 1));
    std::size_t found = 0;
    for (std::uint32_t v = range.begin; v < range.end; ++v) {  // avoids a branch that cannot be predicted
      const Vote& vote = space.votes[v];
      const float k = vote_kernel((vote.centre_camera - centre).squaredNorm(), vote_sigma);
      supports[found] = {v, k * vote.weight};
      found += k > 0.0F ? 1 : 0;
    }
    for (std::size_t i = 0; i < found; ++i)
      workspace.voter_sums.add(space.voter_of_vote[supports[i].first], supports[i].second);
    count += static_cast<int>(found);
  }
  workspace.voter_sums.take(by_voter);
  return count;
}

/// Sums the support by view template, heaviest first.
void sum_by_view(const Forest& forest, const SparseSums::Weights& by_voter, VotingWorkspace::Worker& workspace,
                 SparseSums::Weights& by_view) {
  constexpr std::size_t kAhead = 8;  // voters, so that their cache misses overlap
  const auto entry_of = [&](std::size_t s) { return workspace.space.voters[by_voter[s].first].entry; };
  workspace.view_sums.resize(forest.views.size());
  for (std::size_t i = 0; i < by_voter.size(); ++i) {
    if (i + kAhead < by_voter.size()) hwy::Prefetch(forest.leaf_views.data() + entry_of(i + kAhead).start.view);
    const SupportingEntry entry = entry_of(i);
    for (std::uint32_t v = entry.start.view; v < entry.start.view + entry.leaf_class.view_count; ++v) {
      workspace.view_sums.add(forest.leaf_views[v].view, by_voter[i].second * forest.leaf_views[v].weight.value());
    }
  }
  workspace.view_sums.take(by_view);
  // ties by index, as a stable sort would leave them, which takes memory for each maximum
  std::sort(by_view.begin(), by_view.end(), [](const auto& a, const auto& b) {
    return a.second > b.second || (a.second == b.second && a.first < b.first);
  });
}

/// Returns a maximum with the weight, number and mass of its votes. The mass is the visible part of the object: the
/// votes' weight times the area of their patches.
Hypothesis measure_maximum(const VotingInput& input, const Eigen::Vector3f& centre, VotingWorkspace::Worker& workspace,
                           SparseSums::Weights& by_voter) {
  Hypothesis hypothesis;
  hypothesis.centre_camera = centre;
  hypothesis.vote_count = sum_by_voter(input, centre, workspace, by_voter);
  for (const auto& [index, weight] : by_voter) {
    hypothesis.weight += weight;
    hypothesis.vote_mass += weight * input.patches.area[workspace.space.voters[index].patch];
  }
  return hypothesis;
}

/// Adds the supporting patches and templates to the hypothesis.
void add_support(const Forest& forest, const SparseSums::Weights& by_voter, VotingWorkspace::Worker& workspace,
                 Hypothesis& hypothesis) {
  workspace.by_patch.clear();
  for (const auto& [index, weight] : by_voter) {
    const std::uint32_t patch = workspace.space.voters[index].patch;
    if (workspace.by_patch.empty() || workspace.by_patch.back().first != patch)
      workspace.by_patch.emplace_back(patch, 0.0F);
    workspace.by_patch.back().second += weight;
  }
  hypothesis.patches = workspace.by_patch;
  sum_by_view(forest, by_voter, workspace, hypothesis.views);
}

/// Returns the classes in descending order of their work, so that no thread starts a large one last.
std::vector<std::size_t> order_by_work(std::size_t classes, const PatchPosteriors& posteriors) {
  std::vector<std::size_t> work(classes, 0);
  std::vector<std::size_t> order(classes);
  for (std::size_t c = 0; c < classes; ++c) {
    order[c] = c;
    posteriors.for_each_supporting_patch(
        static_cast<int>(c), [&](std::uint32_t, const SupportingEntry*, std::uint32_t count) { work[c] += count; });
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return work[a] > work[b]; });
  return order;
}

}  // namespace

void SparseSums::resize(std::size_t count) {
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

std::vector<Hypothesis> class_hypotheses(const VotingInput& input, std::size_t class_index,
                                         VotingWorkspace::Worker& workspace) {
  const VotingSettings& settings = input.settings;
  const std::size_t classes = input.forest.classes.size();
  const float min_mass = settings.min_mass_fraction * input.forest.classes[class_index].nominal_vote_mass;
  const std::vector<Eigen::Vector3f> maxima = find_maxima(
      workspace.space, input.camera, settings, per_class_budget(classes, settings.maxima_per_class), workspace.maxima);
  std::vector<Hypothesis> measured;
  std::vector<std::size_t> order;
  measured.reserve(maxima.size());
  order.reserve(maxima.size());
  workspace.by_voter.resize(std::max(workspace.by_voter.size(), maxima.size()));
  for (std::size_t i = 0; i < maxima.size(); ++i) {
    measured.push_back(measure_maximum(input, maxima[i], workspace, workspace.by_voter[i]));
    if (measured.back().vote_mass >= min_mass) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return measured[a].vote_mass > measured[b].vote_mass; });
  const std::size_t sharing = std::max(classes, input.searched_classes);
  const auto maximum = static_cast<std::size_t>(per_class_budget(sharing, settings.candidates_per_class));
  if (order.size() > maximum) order.resize(maximum);
  std::vector<Hypothesis> hypotheses;
  hypotheses.reserve(order.size());
  for (const std::size_t i : order) {
    hypotheses.push_back(std::move(measured[i]));
    hypotheses.back().class_index = class_index;
    add_support(input.forest, workspace.by_voter[i], workspace, hypotheses.back());
  }
  return hypotheses;
}

std::vector<Hypothesis> find_hypotheses(const VotingInput& input, int threads, VotingWorkspace& workspaces) {
  const std::vector<ObjectClass>& classes = input.forest.classes;
  const std::vector<std::size_t> order = order_by_work(classes.size(), input.posteriors);
  std::vector<std::vector<Hypothesis>> by_class(classes.size());
  workspaces.workers.resize(threads);
  parallel_for_workers(threads, static_cast<int>(order.size()), [&](int worker, int i) {
    const std::size_t c = order[static_cast<std::size_t>(i)];
    VotingWorkspace::Worker& workspace = workspaces.workers[worker];
    cast_votes(input, static_cast<int>(c), workspace.casting, workspace.space);
    by_class[c] = class_hypotheses(input, c, workspace);
  });
  std::vector<Hypothesis> all;
  std::size_t count = 0;
  for (const std::vector<Hypothesis>& class_list : by_class) count += class_list.size();
  all.reserve(count);
  for (std::vector<Hypothesis>& class_list : by_class)
    std::move(class_list.begin(), class_list.end(), std::back_inserter(all));
  return all;
}

}  // namespace houghstream
