#include "detector/forest/forest.hpp"

namespace houghstream {

LeafVote::LeafVote(const Eigen::Vector3f& offset_m, float weight_of_class) : weight(weight_of_class) {
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const float in_reach = std::clamp(offset_m[static_cast<Eigen::Index>(i)], -kReach_m, kReach_m);
    steps[i] = static_cast<std::int16_t>(std::lround(in_reach / kStep_m));
  }
}

std::vector<LeafStart> find_leaf_starts(const Forest& forest) {
  std::vector<LeafStart> starts;
  if (forest.leaves.empty()) return starts;
  starts.reserve(forest.leaves.size() - 1);
  LeafStart start;
  for (std::size_t leaf = 0; leaf + 1 < forest.leaves.size(); ++leaf) {
    starts.push_back(start);
    for (std::uint32_t e = forest.leaves[leaf]; e < forest.leaves[leaf + 1]; ++e) start.pass(forest.leaf_classes[e]);
  }
  return starts;
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
