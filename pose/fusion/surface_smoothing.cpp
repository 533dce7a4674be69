#include "pose/fusion/surface_smoothing.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/base/parallel.hpp"

namespace houghstream::fusion {
namespace {

using Neighbours = std::vector<std::vector<std::uint32_t>>;

Neighbours neighbours_of(const Mesh& mesh) {
  Neighbours neighbours(mesh.vertices.size());
  for (const auto& triangle : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      neighbours[triangle[k]].push_back(triangle[(k + 1) % 3]);
      neighbours[triangle[k]].push_back(triangle[(k + 2) % 3]);
    }
  }
  for (std::vector<std::uint32_t>& of_one : neighbours) {
    std::sort(of_one.begin(), of_one.end());
    of_one.erase(std::unique(of_one.begin(), of_one.end()), of_one.end());
  }
  return neighbours;
}

/// Returns the kernel weight of two normals, 1 for equal ones.
float normal_kernel(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  constexpr float kWidth = 0.35F;  // difference of unit vectors: 20 degrees
  return std::exp(-(a - b).squaredNorm() / (2.0F * kWidth * kWidth));
}

}  // namespace

void smooth_surface(int threads, Mesh& mesh) {
  constexpr int kNormalRounds = 10;
  constexpr int kVertexRounds = 10;
  const Neighbours neighbours = neighbours_of(mesh);
  const int n = static_cast<int>(mesh.vertices.size());
  std::vector<Eigen::Vector3f> next(mesh.vertices.size());
  for (int round = 0; round < kNormalRounds; ++round) {
    parallel_for(threads, n, [&](int i) {
      Eigen::Vector3f sum = mesh.normals[i];
      for (const std::uint32_t j : neighbours[i])
        sum += normal_kernel(mesh.normals[i], mesh.normals[j]) * mesh.normals[j];
      next[i] = sum.norm() > 0.0F ? sum.normalized() : mesh.normals[i];
    });
    mesh.normals.swap(next);
  }
  for (int round = 0; round < kVertexRounds; ++round) {
    parallel_for(threads, n, [&](int i) {
      float off = 0.0F;
      float weight = 1.0F;
      for (const std::uint32_t j : neighbours[i]) {
        const float w = normal_kernel(mesh.normals[i], mesh.normals[j]);
        // The mean of both vertices' planes: where they agree nothing moves, on a curved surface either.
        off += 0.5F * w * (mesh.normals[i] + mesh.normals[j]).dot(mesh.vertices[j] - mesh.vertices[i]);
        weight += w;
      }
      next[i] = mesh.vertices[i] + off / weight * mesh.normals[i];
    });
    mesh.vertices.swap(next);
  }
}

}  // namespace houghstream::fusion
