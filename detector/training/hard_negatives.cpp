#include "detector/training/hard_negatives.hpp"

#include <algorithm>

#include "detector/training/tree_trainer.hpp"
#include "pipeline/base/parallel.hpp"

namespace houghstream::training {
namespace {

constexpr int kScouts = 3;
constexpr float kMistaken = 0.2F;  // p(any object) from which a background patch is worth learning

/// Trees that only find out what is mistaken: grown quickly, under numbers that no tree of the forest has.
std::vector<Forest> grow_scouts(const TrainingSet& set, const PatchSettings& patch, const TrainingSettings& settings) {
  TrainingSettings quick = settings;
  quick.tests_per_node = std::min(settings.tests_per_node, 100);
  std::vector<Forest> scouts(kScouts);
  parallel_for(settings.threads, kScouts,
               [&](int t) { scouts[static_cast<std::size_t>(t)] = grow_tree(set, patch, quick, settings.trees + t); });
  return scouts;
}

float object_probability(const TrainingSet& set, const std::vector<Forest>& scouts, const TrainingSample& sample) {
  float sum = 0.0F;
  for (const Forest& scout : scouts) {
    const auto leaf = static_cast<std::size_t>(find_leaf(scout, 0, set.patch(sample)));
    for (std::uint32_t e = scout.leaves[leaf]; e < scout.leaves[leaf + 1]; ++e) {
      sum += scout.leaf_classes[e].probability;
    }
  }
  return sum / static_cast<float>(scouts.size());
}

}  // namespace

void add_hard_negatives(const PatchSettings& patch, const TrainingSettings& settings, TrainingSet& set) {
  const std::vector<Forest> scouts = grow_scouts(set, patch, settings);
  const std::size_t count = set.negative_pool.size();
  std::vector<float> mistake(count);
  constexpr std::size_t kBlock = 4096;
  parallel_for(settings.threads, static_cast<int>((count + kBlock - 1) / kBlock), [&](int block) {
    const std::size_t begin = static_cast<std::size_t>(block) * kBlock;
    for (std::size_t i = begin; i < std::min(begin + kBlock, count); ++i) {
      mistake[i] = object_probability(set, scouts, set.negative_pool[i]);
    }
  });
  std::vector<std::uint32_t> order;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (mistake[i] >= kMistaken) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return mistake[a] > mistake[b]; });
  const auto background = static_cast<std::size_t>(std::count_if(
      set.samples.begin(), set.samples.end(), [](const TrainingSample& sample) { return sample.label == 0; }));
  order.resize(std::min(order.size(), background));
  for (const std::uint32_t i : order) set.samples.push_back(set.negative_pool[i]);
  set.negative_pool = {};
  drop_unread_pixels(patch, set);
}

}  // namespace houghstream::training
