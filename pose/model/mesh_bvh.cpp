#include "pose/model/mesh_bvh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "pipeline/base/checks.hpp"

namespace houghstream {
namespace {

constexpr std::uint32_t kLeafTriangles = 4;

using Corners = std::array<Eigen::Vector3f, 3>;

/// Returns the weight of `b` for the point of the segment that is nearest to `p`.
float along_segment(const Eigen::Vector3f& p, const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  const float length_sq = (b - a).squaredNorm();
  return length_sq > 0.0F ? std::clamp((p - a).dot(b - a) / length_sq, 0.0F, 1.0F) : 0.0F;
}

std::array<float, 3> nearest_on_edges(const Eigen::Vector3f& p, const Corners& c) {
  std::array<float, 3> best = {1.0F, 0.0F, 0.0F};
  float best_sq = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const float fraction = along_segment(p, c[i], c[j]);
    const float distance_sq = (c[i] + fraction * (c[j] - c[i]) - p).squaredNorm();
    if (distance_sq >= best_sq) continue;
    best_sq = distance_sq;
    best = {0.0F, 0.0F, 0.0F};
    best[i] = 1.0F - fraction;
    best[j] = fraction;
  }
  return best;
}

/// Sets `best` to the triangle's point nearest to `p` where that is nearer: below `p` where it stands over the
/// triangle, else on an edge.
void improve(const Eigen::Vector3f& p, const Corners& c, std::uint32_t triangle, ClosestPoint& best) {
  constexpr float kRounding = 1.001F;
  const Eigen::Vector3f normal = (c[1] - c[0]).cross(c[2] - c[0]);
  const float area_sq = normal.squaredNorm();
  const float height = (p - c[0]).dot(normal);
  if (height * height > kRounding * area_sq * best.distance * best.distance) return;  // its plane is farther away
  const auto weights = [&]() -> std::array<float, 3> {
    if (area_sq <= 0.0F) return nearest_on_edges(p, c);
    const float w1 = (p - c[0]).cross(c[2] - c[0]).dot(normal) / area_sq;
    const float w2 = (c[1] - c[0]).cross(p - c[0]).dot(normal) / area_sq;
    const float w0 = 1.0F - w1 - w2;
    return w0 >= 0.0F && w1 >= 0.0F && w2 >= 0.0F ? std::array<float, 3>{w0, w1, w2} : nearest_on_edges(p, c);
  };
  const std::array<float, 3> w = weights();
  const float distance = (w[0] * c[0] + w[1] * c[1] + w[2] * c[2] - p).norm();
  if (distance < best.distance) best = {distance, triangle, w};
}

}  // namespace

MeshBvh::MeshBvh(const Mesh& mesh) : mesh_(mesh), order_(mesh.triangles.size()) {
  require(!mesh.triangles.empty(), "mesh of {} vertices without triangles, expected a surface", mesh.vertices.size());
  std::iota(order_.begin(), order_.end(), 0U);
  build(0, static_cast<std::uint32_t>(order_.size()));
  corners_.reserve(order_.size());
  for (const std::uint32_t triangle : order_) corners_.push_back(corners_of(triangle));
}

MeshBvh::Corners MeshBvh::corners_of(std::uint32_t triangle) const {
  const auto& t = mesh_.triangles[triangle];
  return {mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]};
}

std::uint32_t MeshBvh::build(std::uint32_t first, std::uint32_t count) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({});
  Eigen::AlignedBox3f box;
  for (std::uint32_t i = first; i < first + count; ++i) {
    for (const Eigen::Vector3f& corner : corners_of(order_[i])) box.extend(corner);
  }
  nodes_[index].box = box;
  nodes_[index].first = first;
  if (count <= kLeafTriangles) {
    nodes_[index].count = count;
    return index;
  }
  Eigen::Index side = 0;
  box.sizes().maxCoeff(&side);
  const auto middle = [&](std::uint32_t triangle) {
    const Corners c = corners_of(triangle);
    return c[0][side] + c[1][side] + c[2][side];
  };
  const auto begin = order_.begin() + first;
  std::nth_element(begin, begin + count / 2, begin + count,
                   [&](std::uint32_t a, std::uint32_t b) { return middle(a) < middle(b); });
  build(first, count / 2);
  const std::uint32_t right = build(first + count / 2, count - count / 2);
  nodes_[index].right = right;
  return index;
}

/// `node_distance` is the distance from the point to the node's box, metres.
void MeshBvh::search(std::uint32_t index, float node_distance, const Eigen::Vector3f& point, ClosestPoint& best) const {
  if (node_distance >= best.distance) return;
  const Node& node = nodes_[index];
  for (std::uint32_t i = node.first; i < node.first + node.count; ++i) improve(point, corners_[i], order_[i], best);
  if (node.count > 0) return;
  const float left_sq = nodes_[index + 1].box.squaredExteriorDistance(point);
  const float right_sq = nodes_[node.right].box.squaredExteriorDistance(point);
  if (right_sq < left_sq) {
    search(node.right, std::sqrt(right_sq), point, best);
    search(index + 1, std::sqrt(left_sq), point, best);
  } else {
    search(index + 1, std::sqrt(left_sq), point, best);
    search(node.right, std::sqrt(right_sq), point, best);
  }
}

ClosestPoint MeshBvh::nearest(const Eigen::Vector3f& point, float max_distance) const {
  ClosestPoint best;
  best.distance = max_distance;
  search(0, nodes_.front().box.exteriorDistance(point), point, best);
  return best;
}

ClosestPoint MeshBvh::nearest_with_guess(const Eigen::Vector3f& point, std::uint32_t guess) const {
  constexpr float kRounding = 1.0001F;  // margin, so that among equally near triangles always the same one is found
  ClosestPoint on_guess;
  on_guess.distance = std::numeric_limits<float>::infinity();
  improve(point, corners_of(guess), guess, on_guess);
  const float limit = kRounding * on_guess.distance + std::numeric_limits<float>::min();
  const ClosestPoint best = nearest(point, limit);
  return best.distance < limit ? best : on_guess;
}

}  // namespace houghstream
