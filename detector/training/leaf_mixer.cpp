#include "detector/training/leaf_mixer.hpp"

namespace houghstream {
namespace {

/// Appends an entry of the old forest with its votes and views.
void copy_entry(const Forest& old, const LeafClass& from, float weight, Forest& forest) {
  LeafClass entry = from;
  entry.probability = weight;
  entry.first_vote = static_cast<std::uint32_t>(forest.votes.size());
  entry.first_view = static_cast<std::uint32_t>(forest.leaf_views.size());
  const auto votes = old.votes.begin() + from.first_vote;
  const auto views = old.leaf_views.begin() + from.first_view;
  forest.votes.insert(forest.votes.end(), votes, votes + from.vote_count);
  forest.leaf_views.insert(forest.leaf_views.end(), views, views + from.view_count);
  forest.leaf_classes.push_back(entry);
}

}  // namespace

void mix_in(const KnownLeaf& known, float part, Forest& forest) {
  const Forest& old = *known.forest;
  const auto leaf = static_cast<std::size_t>(known.leaf);
  const float weight = part * old.leaf_weights[leaf];
  const std::size_t first = forest.leaves[forest.leaves.size() - 2];
  float total = weight;  // the background's share is what remains when the objects' are taken off
  for (std::size_t e = first; e < forest.leaf_classes.size(); ++e) {
    LeafClass& entry = forest.leaf_classes[e];
    entry.probability *= forest.leaf_weights.back() * (1.0F - known.old_share);
    total += entry.probability;
  }
  for (std::uint32_t e = old.leaves[leaf]; e < old.leaves[leaf + 1]; ++e) {
    const float before = weight * old.leaf_classes[e].probability;
    copy_entry(old, old.leaf_classes[e], before * known.old_share, forest);
    total -= before * (1.0F - known.old_share);
  }
  for (std::size_t e = first; e < forest.leaf_classes.size(); ++e) {
    forest.leaf_classes[e].probability = total > 0.0F ? forest.leaf_classes[e].probability / total : 0.0F;
  }
  forest.leaves.back() = static_cast<std::uint32_t>(forest.leaf_classes.size());
  forest.leaf_weights.back() = total;
}

std::int32_t copy_leaf(const KnownLeaf& known, Forest& forest) {
  forest.leaves.push_back(static_cast<std::uint32_t>(forest.leaf_classes.size()));
  forest.leaf_weights.push_back(0.0F);
  mix_in(known, 1.0F, forest);
  return static_cast<std::int32_t>(forest.leaves.size()) - 2;
}

}  // namespace houghstream
