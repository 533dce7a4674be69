#include "detector/training/tree_trainer.hpp"

#include <algorithm>
#include <optional>

#include "detector/training/leaves.hpp"
#include "detector/training/split_search.hpp"
#include "pipeline/base/random.hpp"

namespace houghstream::training {
namespace {

using Samples = std::vector<std::uint32_t>;

class TreeGrower {
 public:
  TreeGrower(const TrainingSet& set, const PatchSettings& patch, const TrainingSettings& settings, int tree)
      : set_(set),
        settings_(settings),
        random_(Random::for_item(settings.seed ^ 0x7265655F74ULL, static_cast<std::uint64_t>(tree))) {
    bag_ = draw_bag(tree);
    label_weights_ = weigh_labels();
    // Single pixels' colours tell objects apart, until the light is another one: only every other tree relies on them.
    const bool allow_single_pixel_intensity = tree % 2 == 0;
    search_.emplace(set, patch, settings, label_weights_, allow_single_pixel_intensity);
  }

  /// Grows the old tree with the new samples: they follow its tests and continue to grow where they end.
  Forest grow_onto(const Forest& old, int tree) {
    old_starts_ = find_leaf_starts(old);
    forest_.leaves.push_back(0);
    forest_.roots.push_back(follow(old, old.roots[static_cast<std::size_t>(tree)], bag_, 0));
    return std::move(forest_);
  }

  Forest grow() {
    forest_.leaves.push_back(0);
    forest_.roots.push_back(grow_node(bag_, 0));
    return std::move(forest_);
  }

 private:
  Samples draw_bag(int tree) const {
    Samples bag;
    for (std::uint32_t s = 0; s < set_.samples.size(); ++s) {
      if (in_bag(settings_, tree, set_.samples[s].image)) bag.push_back(s);
    }
    return bag;
  }

  /// Returns weights by which every object weighs the same, see TrainingSettings::max_background_weight.
  std::vector<float> weigh_labels() const {
    std::vector<float> counts(set_.classes.size() + 1, 0.0F);
    for (const std::uint32_t s : bag_) counts[set_.samples[s].label] += 1.0F;
    std::vector<float> weights(counts.size(), 0.0F);
    const auto objects = static_cast<float>(set_.classes.size());
    const float background = std::min(objects, settings_.max_background_weight);  // over one object's weight
    const auto scale = static_cast<float>(bag_.size()) / (objects + background);
    for (std::size_t l = 0; l < counts.size(); ++l) {
      if (counts[l] > 0.0F) weights[l] = scale * (l == 0 ? background : 1.0F) / counts[l];
    }
    return weights;
  }

  Samples subset(const Samples& samples) {
    const auto limit = static_cast<std::size_t>(settings_.node_samples);
    if (samples.size() <= limit) return samples;
    Samples selected = samples;
    for (std::size_t i = 0; i < limit; ++i) {
      std::swap(selected[i],
                selected[i + static_cast<std::size_t>(random_.below(static_cast<int>(selected.size() - i)))]);
    }
    selected.resize(limit);
    std::sort(selected.begin(), selected.end());  // images in order: kinder to the cache
    return selected;
  }

  /// Draws the objective at random (Gall et al. 2011), but chooses the labels in nodes with hardly anything but
  /// background.
  Objective choose_objective(const Samples& samples) {
    std::size_t background = 0;
    bool several_labels = false;
    for (const std::uint32_t s : samples) {
      background += set_.samples[s].label == 0 ? 1 : 0;
      several_labels = several_labels || set_.samples[s].label != set_.samples[samples[0]].label;
    }
    const bool draw_offset = random_.uniform() < settings_.offset_fraction;
    if (!several_labels) return Objective::kOffset;
    return draw_offset && background * 20 < samples.size() * 19 ? Objective::kOffset : Objective::kClass;
  }

  bool has_object(const Samples& samples) const {
    return std::any_of(samples.begin(), samples.end(), [&](std::uint32_t s) { return set_.samples[s].label != 0; });
  }

  std::int32_t make_leaf(const Samples& samples) {
    const std::int32_t leaf =
        add_leaf({set_, settings_, label_weights_, static_cast<float>(bag_.size())}, samples, forest_);
    if (known_) merge_leaf(*known_, static_cast<float>(samples.size()) / static_cast<float>(known_samples_), forest_);
    return -1 - leaf;
  }

  std::int32_t grow_node(const Samples& samples, int depth) {
    const bool small = samples.size() < static_cast<std::size_t>(settings_.min_samples);
    if (small || depth >= settings_.max_depth || !has_object(samples)) return make_leaf(samples);
    const std::optional<PixelTest> test = search_->best_test(subset(samples), choose_objective(samples), random_);
    if (!test) return make_leaf(samples);

    const auto grow = [&](const Samples& side) { return grow_node(side, depth + 1); };
    return add_node(*test, samples, grow, grow);
  }

  /// Appends a node; its children are what the two functions make of the samples on their sides.
  template <typename Left, typename Right>
  std::int32_t add_node(const PixelTest& test, const Samples& samples, const Left& make_left, const Right& make_right) {
    const auto [left, right] = split(test, samples);
    const std::size_t index = forest_.nodes.size();
    forest_.nodes.push_back({test, 0, 0});
    const std::int32_t left_child = make_left(left);
    const std::int32_t right_child = make_right(right);
    forest_.nodes[index].left = left_child;
    forest_.nodes[index].right = right_child;
    return static_cast<std::int32_t>(index);
  }

  std::pair<Samples, Samples> split(const PixelTest& test, const Samples& samples) const {
    std::pair<Samples, Samples> sides;
    for (const std::uint32_t s : samples) {
      const int value = test_value(test, set_.patch(set_.samples[s]));
      (value >= test.threshold ? sides.second : sides.first).push_back(s);
    }
    return sides;
  }

  std::int32_t follow(const Forest& old, std::int32_t at, const Samples& samples, int depth) {
    if (at < 0) return follow_leaf(old, -1 - at, samples, depth);
    const TreeNode& node = old.nodes[static_cast<std::size_t>(at)];
    return add_node(
        node.test, samples, [&](const Samples& left) { return follow(old, node.left, left, depth + 1); },
        [&](const Samples& right) { return follow(old, node.right, right, depth + 1); });
  }

  std::int32_t follow_leaf(const Forest& old, std::int32_t leaf, const Samples& samples, int depth) {
    known_ = ExistingLeaf{&old, leaf, old_starts_[static_cast<std::size_t>(leaf)],
                          compute_mixture(static_cast<float>(old.classes.size()),
                                          static_cast<float>(set_.classes.size()), settings_.max_background_weight)};
    known_samples_ = std::max<std::size_t>(samples.size(), 1);
    if (samples.empty()) return -1 - copy_leaf(*known_, forest_);
    return grow_node(samples, depth);
  }

  const TrainingSet& set_;
  const TrainingSettings& settings_;
  Random random_;
  Samples bag_;
  std::vector<float> label_weights_;
  std::vector<LeafStart> old_starts_;  // starts of the old forest's leaves
  std::optional<ExistingLeaf> known_;  // leaf that the samples have reached
  std::size_t known_samples_ = 1;
  std::optional<SplitSearch> search_;
  Forest forest_;
};

}  // namespace

bool in_bag(const TrainingSettings& settings, int tree, std::int32_t image) {
  Random random = Random::for_item(settings.seed + static_cast<std::uint64_t>(tree), static_cast<std::uint64_t>(image));
  return random.uniform() < settings.in_bag;
}

Forest regrow_tree(const TrainingSet& set, const PatchSettings& patch, const TrainingSettings& settings, int tree,
                   const Forest& old) {
  return TreeGrower(set, patch, settings, tree).grow_onto(old, tree);
}

Forest grow_tree(const TrainingSet& set, const PatchSettings& patch, const TrainingSettings& settings, int tree) {
  return TreeGrower(set, patch, settings, tree).grow();
}

}  // namespace houghstream::training
