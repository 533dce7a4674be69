#include "detector/training/leaf_builder.hpp"

#include <algorithm>
#include <map>

namespace houghstream {
namespace {

/// Offsets nearer than merge_radius become one vote at their mean; the heaviest are kept.
std::vector<LeafVote> merged_votes(const TrainingSet& set, const std::vector<std::uint32_t>& samples,
                                   const TrainingSettings& settings) {
  std::vector<LeafVote> votes;  // weight counts samples until the end
  const float radius_sq = settings.merge_radius * settings.merge_radius;
  for (const std::uint32_t s : samples) {
    const Eigen::Vector3f& offset = set.samples[s].offset;
    LeafVote* nearest = nullptr;
    float nearest_sq = radius_sq;
    for (LeafVote& vote : votes) {
      const float distance_sq = (vote.offset - offset).squaredNorm();
      if (distance_sq < nearest_sq) {
        nearest = &vote;
        nearest_sq = distance_sq;
      }
    }
    if (nearest == nullptr) {
      votes.push_back({offset, 1.0F});
    } else {
      nearest->weight += 1.0F;
      nearest->offset += (offset - nearest->offset) / nearest->weight;
    }
  }
  std::stable_sort(votes.begin(), votes.end(),
                   [](const LeafVote& a, const LeafVote& b) { return a.weight > b.weight; });
  if (votes.size() > static_cast<std::size_t>(settings.max_leaf_votes))
    votes.resize(static_cast<std::size_t>(settings.max_leaf_votes));
  for (LeafVote& vote : votes) vote.weight /= static_cast<float>(samples.size());
  return votes;
}

std::vector<LeafView> counted_views(const TrainingSet& set, const std::vector<std::uint32_t>& samples,
                                    const TrainingSettings& settings) {
  std::map<std::uint32_t, int> counts;
  for (const std::uint32_t s : samples) ++counts[set.first_view + set.samples[s].view];
  std::vector<LeafView> views;
  views.reserve(counts.size());
  for (const auto& [view, count] : counts) {
    views.push_back({view, static_cast<float>(count) / static_cast<float>(samples.size())});
  }
  std::stable_sort(views.begin(), views.end(),
                   [](const LeafView& a, const LeafView& b) { return a.weight > b.weight; });
  if (views.size() > static_cast<std::size_t>(settings.max_leaf_views))
    views.resize(static_cast<std::size_t>(settings.max_leaf_views));
  return views;
}

}  // namespace

std::int32_t add_leaf(const TrainingSet& set, const std::vector<std::uint32_t>& samples,
                      const std::vector<float>& label_weights, float bag_weight, const TrainingSettings& settings,
                      Forest& forest) {
  std::vector<std::vector<std::uint32_t>> by_label(label_weights.size());
  for (const std::uint32_t s : samples) by_label[set.samples[s].label].push_back(s);
  float total = 0.0F;
  for (std::size_t l = 0; l < by_label.size(); ++l) total += label_weights[l] * static_cast<float>(by_label[l].size());

  for (std::size_t l = 1; l < by_label.size(); ++l) {
    if (by_label[l].empty()) continue;
    const std::vector<LeafVote> votes = merged_votes(set, by_label[l], settings);
    const std::vector<LeafView> views = counted_views(set, by_label[l], settings);
    LeafClass entry;
    entry.class_index = static_cast<std::uint16_t>(set.first_class + l - 1);
    entry.vote_count = static_cast<std::uint8_t>(votes.size());
    entry.view_count = static_cast<std::uint8_t>(views.size());
    entry.first_vote = static_cast<std::uint32_t>(forest.votes.size());
    entry.first_view = static_cast<std::uint32_t>(forest.leaf_views.size());
    entry.probability = label_weights[l] * static_cast<float>(by_label[l].size()) / total;
    forest.leaf_classes.push_back(entry);
    forest.votes.insert(forest.votes.end(), votes.begin(), votes.end());
    forest.leaf_views.insert(forest.leaf_views.end(), views.begin(), views.end());
  }
  forest.leaves.push_back(static_cast<std::uint32_t>(forest.leaf_classes.size()));
  forest.leaf_weights.push_back(total / bag_weight);
  return static_cast<std::int32_t>(forest.leaves.size()) - 2;
}

}  // namespace houghstream
