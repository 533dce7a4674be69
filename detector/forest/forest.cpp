#include "detector/forest/forest.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace houghstream {

void note_leaf_heads(Forest& forest) {
  forest.leaf_heads.assign(forest.leaves.size(), LeafHead{});
  for (std::size_t leaf = 0; leaf + 1 < forest.leaves.size(); ++leaf) {
    LeafHead& head = forest.leaf_heads[leaf];
    head.first_class = forest.leaves[leaf];
    for (std::uint32_t e = forest.leaves[leaf]; e < forest.leaves[leaf + 1]; ++e) {
      head.certainty = std::max(head.certainty, forest.leaf_classes[e].probability);
    }
  }
  forest.leaf_heads.back().first_class = forest.leaves.back();
}

void note_view_neighbours(Forest& forest) {
  std::vector<std::vector<std::uint32_t>> by_class(forest.classes.size());
  for (std::uint32_t view = 0; view < forest.views.size(); ++view)
    by_class.at(forest.views[view].class_index).push_back(view);
  forest.view_neighbours.resize(forest.views.size());
  std::vector<std::pair<float, std::uint32_t>> others;
  for (const std::vector<std::uint32_t>& views : by_class) {
    for (const std::uint32_t view : views) {
      const auto R = forest.views[view].R_ray_object.coeffs();
      others.clear();
      for (const std::uint32_t other : views) {
        if (other == view) continue;
        others.emplace_back(-std::abs(R.dot(forest.views[other].R_ray_object.coeffs())), other);
      }
      ViewNeighbours& nearest = forest.view_neighbours[view];
      nearest.fill(view);
      const std::size_t count = std::min(nearest.size(), others.size());
      std::partial_sort(others.begin(), others.begin() + static_cast<std::ptrdiff_t>(count), others.end());
      for (std::size_t i = 0; i < count; ++i) nearest[i] = others[i].second;
    }
  }
}

Eigen::Matrix3f ray_rotation(const Eigen::Vector3f& ray) {
  const Eigen::Vector3f d = ray / ray.norm();
  // Rodrigues' formula for the axis z x d, simplified: the rotation angle's cosine is d.z, and rays point forwards.
  const float k = 1.0F / (1.0F + d.z());
  Eigen::Matrix3f rotation;
  rotation << 1.0F - k * d.x() * d.x(), -k * d.x() * d.y(), d.x(),  //
      -k * d.x() * d.y(), 1.0F - k * d.y() * d.y(), d.y(),          //
      -d.x(), -d.y(), d.z();
  return rotation;
}

std::int32_t find_leaf(const Forest& forest, int tree, const PatchView& patch) {
  std::int32_t at = forest.roots[static_cast<std::size_t>(tree)];
  while (at >= 0) {
    const TreeNode& node = forest.nodes[static_cast<std::size_t>(at)];
    const bool right = test_value(node.test, patch) >= node.test.threshold;
    at = right ? node.right : node.left;
  }
  return -1 - at;
}

}  // namespace houghstream
