#include "detector/forest/forest_index.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace houghstream {
namespace {

std::vector<LeafSummary> make_leaf_heads(const Forest& forest) {
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

/// Finds the neighbours by the angle between the views' R_ray_object.
std::vector<ViewNeighbours> find_view_neighbours(const Forest& forest) {
  std::vector<std::vector<std::uint32_t>> by_class(forest.classes.size());
  for (std::uint32_t view = 0; view < forest.views.size(); ++view)
    by_class.at(forest.views[view].class_index).push_back(view);
  std::vector<ViewNeighbours> neighbours(forest.views.size());
  std::vector<std::pair<float, std::uint32_t>> others;
  for (const std::vector<std::uint32_t>& views : by_class) {
    for (const std::uint32_t view : views) {
      const auto R = forest.views[view].R_ray_object.coeffs();
      others.clear();
      for (const std::uint32_t other : views) {
        if (other == view) continue;
        others.emplace_back(-std::abs(R.dot(forest.views[other].R_ray_object.coeffs())), other);
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

}  // namespace

ForestIndex::ForestIndex(const Forest& forest)
    : forest_(&forest),
      leaf_heads_(make_leaf_heads(forest)),
      packed_(pack_trees(forest)),
      view_neighbours_(find_view_neighbours(forest)) {}

}  // namespace houghstream
