#include "detector/forest/forest_index.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace houghstream {
namespace {

std::vector<LeafSummary> build_leaf_summaries(const Forest& forest) {
  std::vector<LeafSummary> summaries(forest.leaves.size());
  for (std::size_t leaf = 0; leaf + 1 < forest.leaves.size(); ++leaf) {
    LeafSummary& summary = summaries[leaf];
    summary.first_class = forest.leaves[leaf];
    for (std::uint32_t e = forest.leaves[leaf]; e < forest.leaves[leaf + 1]; ++e) {
      summary.max_posterior = std::max(summary.max_posterior, forest.leaf_classes[e].probability);
    }
  }
  if (!summaries.empty()) summaries.back().first_class = forest.leaves.back();
  return summaries;
}

/// The rotations of a class' views, side by side: in the forest they lie among templates, a cache miss each.
struct ClassViews {
  std::vector<std::uint32_t> views;  ///< indices into Forest::views
  std::vector<Eigen::Vector4f> rotations;

  /// Returns a measure of how near the rotations of two of the views are: the cosine of half the angle between them.
  float nearness(std::size_t a, std::size_t b) const { return std::abs(rotations[a].dot(rotations[b])); }
};

/// Lists the views of each class.
std::vector<ClassViews> views_by_class(const Forest& forest) {
  std::vector<ClassViews> by_class(forest.classes.size());
  for (std::uint32_t view = 0; view < forest.views.size(); ++view) {
    ClassViews& class_views = by_class.at(forest.views[view].class_index);
    class_views.views.push_back(view);
    class_views.rotations.emplace_back(forest.views[view].R_ray_object.coeffs());
  }
  return by_class;
}

/// Finds the neighbours by the angle between the views' R_ray_object.
std::vector<ViewNeighbours> find_view_neighbours(const std::vector<ClassViews>& by_class, std::size_t count) {
  std::vector<ViewNeighbours> neighbours(count);
  std::vector<std::pair<float, std::uint32_t>> others;
  for (const ClassViews& class_views : by_class) {
    for (std::size_t i = 0; i < class_views.views.size(); ++i) {
      others.clear();
      for (std::size_t k = 0; k < class_views.views.size(); ++k) {
        if (k != i) others.emplace_back(-class_views.nearness(i, k), class_views.views[k]);
      }
      ViewNeighbours& nearest = neighbours[class_views.views[i]];
      nearest.fill(class_views.views[i]);
      const std::size_t most = std::min(nearest.size(), others.size());
      std::partial_sort(others.begin(), others.begin() + static_cast<std::ptrdiff_t>(most), others.end());
      for (std::size_t k = 0; k < most; ++k) nearest[k] = others[k].second;
    }
  }
  return neighbours;
}

/// Chooses of a class's views the next one as far as can be from those chosen before it.
SampledViews sample_views(const ClassViews& class_views) {
  std::vector<std::size_t> chosen;                                        // places in the class' list
  std::vector<float> nearness_to_chosen(class_views.views.size(), 0.0F);  // of the nearest one
  std::size_t next = 0;
  while (chosen.size() < std::min(class_views.views.size(), SampledViews::kCount)) {
    chosen.push_back(next);
    nearness_to_chosen[next] = std::numeric_limits<float>::infinity();
    for (std::size_t i = 0; i < class_views.views.size(); ++i)
      nearness_to_chosen[i] = std::max(nearness_to_chosen[i], class_views.nearness(next, i));
    const auto farthest = std::min_element(nearness_to_chosen.begin(), nearness_to_chosen.end());
    next = static_cast<std::size_t>(farthest - nearness_to_chosen.begin());
  }
  SampledViews sampled;
  const auto coarse_end = chosen.begin() + static_cast<std::ptrdiff_t>(std::min(chosen.size(), SampledViews::kCoarse));
  for (const std::size_t view : chosen) {
    const auto is_farther = [&](std::size_t a, std::size_t b) {
      return class_views.nearness(view, a) < class_views.nearness(view, b);
    };
    const auto nearest = std::max_element(chosen.begin(), coarse_end, is_farther);
    sampled.views.push_back(class_views.views[view]);
    sampled.nearest.push_back(static_cast<std::uint32_t>(nearest - chosen.begin()));
  }
  return sampled;
}

}  // namespace

ForestIndex::ForestIndex(const Forest& forest)
    : forest_(&forest),
      leaf_summaries_(build_leaf_summaries(forest)),
      leaf_starts_(find_leaf_starts(forest)),
      packed_(pack_trees(forest)) {
  const std::vector<ClassViews> by_class = views_by_class(forest);
  view_neighbours_ = find_view_neighbours(by_class, forest.views.size());
  constexpr float kOneAttitude = 150.0F;  // views of a turntable
  for (const ClassViews& class_views : by_class) {
    sampled_views_.push_back(sample_views(class_views));
    attitude_factors_.push_back(
        std::clamp(static_cast<float>(class_views.views.size()) / kOneAttitude, 1.0F, kMaxAttitudeFactor));
  }
}

}  // namespace houghstream
