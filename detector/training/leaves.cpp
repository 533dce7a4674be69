#include "detector/training/leaves.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace houghstream::training {
namespace {

/// Offsets nearer than merge_radius become one vote at their mean; the heaviest are kept.
std::vector<LeafVote> merged_votes(const TrainingSet& set, const std::vector<std::uint32_t>& samples,
                                   const TrainingSettings& settings) {
  struct MergedOffset {
    Eigen::Vector3f mean;
    float count = 0.0F;
  };
  std::vector<MergedOffset> merged;
  const float radius_sq = settings.merge_radius * settings.merge_radius;
  for (const std::uint32_t s : samples) {
    const Eigen::Vector3f& offset = set.samples[s].offset;
    MergedOffset* nearest = nullptr;
    float nearest_sq = radius_sq;
    for (MergedOffset& other : merged) {
      const float distance_sq = (other.mean - offset).squaredNorm();
      if (distance_sq < nearest_sq) {
        nearest = &other;
        nearest_sq = distance_sq;
      }
    }
    if (nearest == nullptr) {
      merged.push_back({offset, 1.0F});
    } else {
      nearest->count += 1.0F;
      nearest->mean += (offset - nearest->mean) / nearest->count;
    }
  }
  std::stable_sort(merged.begin(), merged.end(),
                   [](const MergedOffset& a, const MergedOffset& b) { return a.count > b.count; });
  if (merged.size() > static_cast<std::size_t>(settings.max_leaf_votes))
    merged.resize(static_cast<std::size_t>(settings.max_leaf_votes));
  std::vector<LeafVote> votes;
  votes.reserve(merged.size());
  for (const MergedOffset& offset : merged)
    votes.emplace_back(offset.mean, offset.count / static_cast<float>(samples.size()));
  return votes;
}

std::vector<LeafView> counted_views(const TrainingSet& set, const std::vector<std::uint32_t>& samples,
                                    const TrainingSettings& settings) {
  std::map<std::uint32_t, int> counts;
  for (const std::uint32_t s : samples) ++counts[set.first_view + set.samples[s].view];
  std::vector<std::pair<std::uint32_t, int>> most(counts.begin(), counts.end());
  std::stable_sort(most.begin(), most.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  if (most.size() > static_cast<std::size_t>(settings.max_leaf_views))
    most.resize(static_cast<std::size_t>(settings.max_leaf_views));
  std::vector<LeafView> views;
  views.reserve(most.size());
  for (const auto& [view, count] : most) {
    const Share weight(static_cast<float>(count) / static_cast<float>(samples.size()));
    views.push_back({static_cast<std::uint16_t>(view), weight});
  }
  return views;
}

/// Appends an entry of the old forest with its votes and views, which start there at `start`.
void copy_entry(const Forest& old, const LeafClass& from, const LeafStart& start, float weight, Forest& forest) {
  LeafClass entry = from;
  entry.probability = weight;
  const auto votes = old.votes.begin() + start.vote;
  const auto views = old.leaf_views.begin() + start.view;
  forest.votes.insert(forest.votes.end(), votes, votes + from.vote_count);
  forest.leaf_views.insert(forest.leaf_views.end(), views, views + from.view_count);
  forest.leaf_classes.push_back(entry);
}

}  // namespace

std::int32_t add_leaf(const LeafSource& source, const std::vector<std::uint32_t>& samples, Forest& forest) {
  const TrainingSet& set = source.set;
  const std::vector<float>& label_weights = source.label_weights;
  std::vector<std::vector<std::uint32_t>> by_label(label_weights.size());
  for (const std::uint32_t s : samples) by_label[set.samples[s].label].push_back(s);
  float total = 0.0F;
  for (std::size_t l = 0; l < by_label.size(); ++l) total += label_weights[l] * static_cast<float>(by_label[l].size());

  for (std::size_t l = 1; l < by_label.size(); ++l) {
    if (by_label[l].empty()) continue;
    const std::vector<LeafVote> votes = merged_votes(set, by_label[l], source.settings);
    const std::vector<LeafView> views = counted_views(set, by_label[l], source.settings);
    LeafClass entry;
    entry.class_index = static_cast<std::uint16_t>(set.first_class + l - 1);
    entry.vote_count = static_cast<std::uint8_t>(votes.size());
    entry.view_count = static_cast<std::uint8_t>(views.size());
    entry.probability = label_weights[l] * static_cast<float>(by_label[l].size()) / total;
    forest.leaf_classes.push_back(entry);
    forest.votes.insert(forest.votes.end(), votes.begin(), votes.end());
    forest.leaf_views.insert(forest.leaf_views.end(), views.begin(), views.end());
  }
  forest.leaves.push_back(static_cast<std::uint32_t>(forest.leaf_classes.size()));
  forest.leaf_weights.push_back(total / source.bag_weight);
  return static_cast<std::int32_t>(forest.leaves.size()) - 2;
}

LeafMixture compute_mixture(float known_classes, float added_classes, float max_background_weight) {
  // Over one object's weight.
  const auto background = [&](float classes) { return std::min(classes, max_background_weight); };
  const float classes = known_classes + added_classes;
  const float whole = classes + background(classes);
  LeafMixture mixture;
  mixture.added = (added_classes + background(added_classes)) / whole;
  mixture.known = (known_classes + background(known_classes)) / whole;
  mixture.background = mixture.known * background(classes) / background(known_classes);
  return mixture;
}

void merge_leaf(const ExistingLeaf& known, float part, Forest& forest) {
  const Forest& old = *known.forest;
  const auto leaf = static_cast<std::size_t>(known.leaf);
  const float weight = part * old.leaf_weights[leaf];
  const std::size_t first = forest.leaves[forest.leaves.size() - 2];
  // The background is what remains when the objects are taken off.
  float total = weight * known.mixture.background;
  for (std::size_t e = first; e < forest.leaf_classes.size(); ++e) {
    LeafClass& entry = forest.leaf_classes[e];
    entry.probability *= forest.leaf_weights.back() * known.mixture.added;
    total += entry.probability;
  }
  LeafStart start = known.start;
  for (std::uint32_t e = old.leaves[leaf]; e < old.leaves[leaf + 1]; ++e) {
    const float before = weight * old.leaf_classes[e].probability;
    copy_entry(old, old.leaf_classes[e], start, before * known.mixture.known, forest);
    start.pass(old.leaf_classes[e]);
    total += before * (known.mixture.known - known.mixture.background);
  }
  for (std::size_t e = first; e < forest.leaf_classes.size(); ++e) {
    forest.leaf_classes[e].probability = total > 0.0F ? forest.leaf_classes[e].probability / total : 0.0F;
  }
  forest.leaves.back() = static_cast<std::uint32_t>(forest.leaf_classes.size());
  forest.leaf_weights.back() = total;
}

std::int32_t copy_leaf(const ExistingLeaf& known, Forest& forest) {
  forest.leaves.push_back(static_cast<std::uint32_t>(forest.leaf_classes.size()));
  forest.leaf_weights.push_back(0.0F);
  merge_leaf(known, 1.0F, forest);
  return static_cast<std::int32_t>(forest.leaves.size()) - 2;
}

}  // namespace houghstream::training
