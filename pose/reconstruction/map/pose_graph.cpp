#include "pose/reconstruction/map/pose_graph.hpp"

#include <Eigen/Cholesky>
#include <deque>

#include "pose/motion/twist.hpp"

namespace houghstream::reconstruction {
namespace {

/// Returns the weight of an edge by its residual: where this is large, the edge is an outlier.
double robust_weight(const Vector6& error) {
  constexpr double kShift_m = 0.006;
  constexpr double kAngle = 0.02;
  const double shift = error.head<3>().norm() / kShift_m;
  const double angle = error.tail<3>().norm() / kAngle;
  const double scale = 1.0 + shift * shift + angle * angle;
  return 1.0 / (scale * scale);  // Geman & McClure
}

}  // namespace

void optimise_pose_graph(const std::vector<PoseEdge>& edges, std::vector<Eigen::Isometry3d>& T_camera_world) {
  constexpr int kIterations = 12;
  // The first iterations are unweighted: before the loop's error is spread, the closing edge would look like an
  // outlier.
  constexpr int kUnweightedIterations = 4;
  constexpr double kConvergence = 1e-6;
  const auto n = static_cast<Eigen::Index>(T_camera_world.size());
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(6 * n, 6 * n);
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(6 * n);
    for (const PoseEdge& edge : edges) {
      const auto i = static_cast<std::size_t>(edge.from);
      const auto j = static_cast<std::size_t>(edge.to);
      const Vector6 error =
          local_coordinates_about_body((edge.T_to_from * T_camera_world[i]).inverse() * T_camera_world[j]);
      const Matrix6 weight = edge.information * (iteration < kUnweightedIterations ? 1.0 : robust_weight(error));
      hessian.block<6, 6>(6 * edge.from, 6 * edge.from) += weight;
      hessian.block<6, 6>(6 * edge.to, 6 * edge.to) += weight;
      hessian.block<6, 6>(6 * edge.from, 6 * edge.to) -= weight;
      hessian.block<6, 6>(6 * edge.to, 6 * edge.from) -= weight;
      gradient.segment<6>(6 * edge.from) -= weight * error;
      gradient.segment<6>(6 * edge.to) += weight * error;
    }
    hessian.diagonal().array() += 1.0;
    hessian.topLeftCorner<6, 6>().diagonal().array() += 1e12;
    const Eigen::VectorXd step = hessian.ldlt().solve(-gradient);
    if (!step.allFinite()) return;
    for (Eigen::Index k = 1; k < n; ++k) {
      Eigen::Isometry3d& T = T_camera_world[static_cast<std::size_t>(k)];
      T = retract_about_body(T, step.segment<6>(6 * k));
    }
    if (iteration >= kUnweightedIterations && step.lpNorm<Eigen::Infinity>() < kConvergence) return;
  }
}

std::vector<int> graph_distances(int start, int poses, const std::vector<PoseEdge>& edges) {
  std::vector<int> distances(static_cast<std::size_t>(poses), -1);
  std::vector<std::vector<int>> adjacent(static_cast<std::size_t>(poses));
  for (const PoseEdge& edge : edges) {
    adjacent[static_cast<std::size_t>(edge.from)].push_back(edge.to);
    adjacent[static_cast<std::size_t>(edge.to)].push_back(edge.from);
  }
  std::deque<int> queue = {start};
  distances[static_cast<std::size_t>(start)] = 0;
  while (!queue.empty()) {
    const int pose = queue.front();
    queue.pop_front();
    for (const int to : adjacent[static_cast<std::size_t>(pose)]) {
      if (distances[static_cast<std::size_t>(to)] >= 0) continue;
      distances[static_cast<std::size_t>(to)] = distances[static_cast<std::size_t>(pose)] + 1;
      queue.push_back(to);
    }
  }
  return distances;
}

}  // namespace houghstream::reconstruction
