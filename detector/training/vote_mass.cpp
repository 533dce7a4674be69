#include "detector/training/vote_mass.hpp"

#include <map>

#include "detector/training/tree_trainer.hpp"
#include "detector/voting/hough_space.hpp"
#include "pipeline/base/parallel.hpp"

namespace houghstream::training {
namespace {

/// Returns the weight that the votes of a leaf, which start at `start`, give to the true centre.
float support_at_ground_truth(const Forest& forest, std::size_t leaf, LeafStart start, const TrainingSample& sample,
                              std::size_t class_index, float vote_sigma) {
  float support = 0.0F;
  for (std::uint32_t e = forest.leaves[leaf]; e < forest.leaves[leaf + 1]; start.pass(forest.leaf_classes[e++])) {
    const LeafClass& entry = forest.leaf_classes[e];
    if (entry.class_index != class_index) continue;
    for (std::uint32_t v = start.vote; v < start.vote + entry.vote_count; ++v) {
      const float distance_sq = (forest.votes[v].offset() - sample.offset).squaredNorm();
      support += entry.probability * forest.votes[v].weight.value() * vote_kernel(distance_sq, vote_sigma);
    }
  }
  return support;
}

struct Tally {
  double support = 0.0;
  double count = 0.0;
};

/// Returns the support of one tree per class, over the samples it did not learn from.
std::vector<Tally> out_of_bag_support(const TrainingSet& set, const TrainingSettings& settings, float vote_sigma,
                                      const Forest& forest, int tree) {
  const std::vector<LeafStart> starts = find_leaf_starts(forest);
  std::vector<Tally> tallies(set.classes.size());
  for (const TrainingSample& sample : set.samples) {
    if (sample.label == 0 || in_bag(settings, tree, sample.image)) continue;
    const auto leaf = static_cast<std::size_t>(find_leaf(forest, tree, set.patch(sample)));
    Tally& tally = tallies[sample.label - 1U];
    tally.support +=
        support_at_ground_truth(forest, leaf, starts[leaf], sample, set.first_class + sample.label - 1U, vote_sigma);
    tally.count += 1.0;
  }
  return tallies;
}

/// Returns by class id the probability that a leaf gives to the class, mean over the class's own patches.
std::map<int, double> mean_probabilities(const Forest& forest) {
  struct Sum {
    double patches = 0.0;
    double probability = 0.0;
  };
  std::vector<Sum> sums(forest.classes.size());
  for (std::size_t l = 0; l + 1 < forest.leaves.size(); ++l) {
    for (std::uint32_t e = forest.leaves[l]; e < forest.leaves[l + 1]; ++e) {
      const auto probability = static_cast<double>(forest.leaf_classes[e].probability);
      const double patches = probability * static_cast<double>(forest.leaf_weights[l]);
      Sum& sum = sums[forest.leaf_classes[e].class_index];
      sum.patches += patches;
      sum.probability += patches * probability;
    }
  }
  std::map<int, double> means;
  for (std::size_t c = 0; c < sums.size(); ++c) {
    if (sums[c].patches > 0.0) means[forest.classes[c].class_id] = sums[c].probability / sums[c].patches;
  }
  return means;
}

}  // namespace

void estimate_nominal_vote_mass(const TrainingSet& set, const TrainingSettings& settings, float vote_sigma,
                                Forest& forest) {
  const int trees = static_cast<int>(forest.roots.size());
  std::vector<std::vector<Tally>> by_tree(static_cast<std::size_t>(trees));
  parallel_for(settings.threads, trees, [&](int t) {
    by_tree[static_cast<std::size_t>(t)] = out_of_bag_support(set, settings, vote_sigma, forest, t);
  });
  for (std::size_t c = 0; c < set.classes.size(); ++c) {
    Tally sum;
    for (const std::vector<Tally>& tallies : by_tree) {
      sum.support += tallies[c].support;
      sum.count += tallies[c].count;
    }
    // The visible area alone is the measure where nothing was left out, or nothing found its centre.
    const double mean_support = sum.support > 0.0 ? sum.support / sum.count : 1.0;
    forest.classes[set.first_class + c].nominal_vote_mass = static_cast<float>(set.visible_areas[c] * mean_support);
  }
}

void rescale_nominal_vote_mass(const Forest& before, Forest& after) {
  const std::map<int, double> earlier = mean_probabilities(before);
  const std::map<int, double> now = mean_probabilities(after);
  for (ObjectClass& object : after.classes) {
    const auto was = earlier.find(object.class_id);
    const auto is = now.find(object.class_id);
    if (was == earlier.end() || is == now.end()) continue;
    object.nominal_vote_mass *= static_cast<float>(is->second / was->second);
  }
}

}  // namespace houghstream::training
