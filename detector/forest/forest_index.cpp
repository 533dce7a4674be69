#include "detector/forest/forest_index.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace houghstream {
namespace {

std::vector<LeafSummary> build_leaf_summaries(const Forest& forest) {
  std::vector<LeafSummary> heads(forest.leaves.size());
  for (std::size_t leaf = 0; leaf + 1 < forest.leaves.size(); ++leaf) {
    LeafSummary& head = heads[leaf];
    head.first_class = forest.leaves[leaf];
    for (std::uint32_t e = forest.leaves[leaf]; e < forest.leaves[leaf + 1]; ++e) {
      head.max_posterior = std::max(head.max_posterior, forest.leaf_classes[e].probability);
    }
  }
  if (!heads.empty()) heads.back().first_class = forest.leaves.back();
  return heads;
}

/// Lists the views of each class.
std::vector<std::vector<std::uint32_t>> views_by_class(const Forest& forest) {
  std::vector<std::vector<std::uint32_t>> by_class(forest.classes.size());
  for (std::uint32_t view = 0; view < forest.views.size(); ++view)
    by_class.at(forest.views[view].class_index).push_back(view);
  return by_class;
}

/// Returns a measure of how near two views' R_ray_object are: the cosine of half the angle between them.
float nearness(const ViewTemplate& a, const ViewTemplate& b) {
  return std::abs(a.R_ray_object.coeffs().dot(b.R_ray_object.coeffs()));
}

/// Finds the neighbours by the angle between the views' R_ray_object.
std::vector<ViewNeighbours> find_view_neighbours(const Forest& forest) {
  std::vector<ViewNeighbours> neighbours(forest.views.size());
  std::vector<std::pair<float, std::uint32_t>> others;
  for (const std::vector<std::uint32_t>& views : views_by_class(forest)) {
    for (const std::uint32_t view : views) {
      others.clear();
      for (const std::uint32_t other : views) {
        if (other == view) continue;
        others.emplace_back(-nearness(forest.views[view], forest.views[other]), other);
      }
      ViewNeighbours& nearest = neighbours[view];
      nearest.fill(view);
      const std::size_t count = std::min(nearest.size(), others.size());
      std::partial_sort(others.begin(), others.begin() + static_cast<std::ptrdiff_t>(count), others.end());
      for (std::size_t i = 0; i < count; ++i) nearest[i] = others[i].second;
    }
  }
  return neighbours;
}

/// Chooses of a class's views the next one as far as can be from those chosen before it.
SpreadViews choose_spread_views(const Forest& forest, const std::vector<std::uint32_t>& views) {
  SpreadViews spread;
  std::vector<float> nearness_to_chosen(views.size(), 0.0F);  // of the nearest one
  std::size_t next = 0;
  while (spread.views.size() < std::min(views.size(), SpreadViews::kCount)) {
    const ViewTemplate& chosen = forest.views[views[next]];
    spread.views.push_back(views[next]);
    nearness_to_chosen[next] = std::numeric_limits<float>::infinity();
    for (std::size_t i = 0; i < views.size(); ++i)
      nearness_to_chosen[i] = std::max(nearness_to_chosen[i], nearness(chosen, forest.views[views[i]]));
    const auto farthest = std::min_element(nearness_to_chosen.begin(), nearness_to_chosen.end());
    next = static_cast<std::size_t>(farthest - nearness_to_chosen.begin());
  }
  const auto coarse_end = spread.views.begin() + std::min(spread.views.size(), SpreadViews::kCoarse);
  for (const std::uint32_t view : spread.views) {
    const auto is_farther = [&](std::uint32_t a, std::uint32_t b) {
      return nearness(forest.views[view], forest.views[a]) < nearness(forest.views[view], forest.views[b]);
    };
    const auto nearest = std::max_element(spread.views.begin(), coarse_end, is_farther);
    spread.nearest.push_back(static_cast<std::uint32_t>(nearest - spread.views.begin()));
  }
  return spread;
}

std::vector<SpreadViews> choose_spread_views(const Forest& forest) {
  std::vector<SpreadViews> spread;
  for (const std::vector<std::uint32_t>& views : views_by_class(forest))
    spread.push_back(choose_spread_views(forest, views));
  return spread;
}

}  // namespace

ForestIndex::ForestIndex(const Forest& forest)
    : forest_(&forest),
      leaf_summaries_(build_leaf_summaries(forest)),
      packed_(pack_trees(forest)),
      view_neighbours_(find_view_neighbours(forest)),
      spread_views_(choose_spread_views(forest)) {}

}  // namespace houghstream
