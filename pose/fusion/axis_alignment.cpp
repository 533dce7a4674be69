#include "pose/fusion/axis_alignment.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "pipeline/base/parallel.hpp"

namespace houghstream::fusion {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;  // rotation, translation; camera frame
using Matrix6d = Eigen::Matrix<double, 6, 6>;

struct Equations {
  Matrix6d squares = Matrix6d::Zero();
  Vector6d sums = Vector6d::Zero();
  double weight = 0.0;
  std::vector<double> distances;  ///< metres, absolute

  void add(const Equations& other) {
    squares += other.squares;
    sums += other.sums;
    weight += other.weight;
    distances.insert(distances.end(), other.distances.begin(), other.distances.end());
  }
};

Eigen::Vector3d direction_to_camera(const DepthView& view) {
  return view.T_camera_object.inverse().translation().normalized();
}

std::vector<std::vector<int>> find_neighbours(const std::vector<DepthView>& views, int maximum) {
  constexpr double kMinCosine = 0.7;  // farther round, too little is seen by both
  std::vector<std::vector<int>> neighbours(views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    std::vector<std::pair<double, int>> by_angle;
    for (std::size_t j = 0; j < views.size(); ++j) {
      const double cosine = direction_to_camera(views[i]).dot(direction_to_camera(views[j]));
      if (j != i && cosine > kMinCosine) by_angle.emplace_back(-cosine, static_cast<int>(j));
    }
    std::sort(by_angle.begin(), by_angle.end());
    // Near neighbours constrain the axis little, far ones much: the neighbours are spread over all that see the same
    // surface.
    const std::size_t count = std::min(static_cast<std::size_t>(maximum), by_angle.size());
    for (std::size_t k = 0; k < count; ++k) neighbours[i].push_back(by_angle[k * by_angle.size() / count].second);
  }
  return neighbours;
}

double tukey_weight(double distance, double limit) {
  const double part = 1.0 - distance * distance / (limit * limit);
  return part > 0.0 ? part * part : 0.0;
}

/// Compares points of one view with the surface of another.
Equations compare(const std::vector<SurfaceSample>& samples, const DepthView& from, const DepthView& to,
                  double limit_m) {
  constexpr double kMinCosine = 0.7;  // minimum cosine between two normals of one surface
  const Eigen::Isometry3d T_to_from = to.T_camera_object * from.T_camera_object.inverse();
  const Eigen::Matrix3d R = T_to_from.linear();
  Equations out;
  for (const SurfaceSample& sample : samples) {
    const Eigen::Vector3d p = T_to_from * sample.point;
    const auto px = to.pixel_of(p);
    if (!px || !std::isfinite(to.depth.at<float>(*px))) continue;
    const Eigen::Vector3d n = to.normal(*px);
    const double distance = n.dot(p - to.camera.backproject(px->x, px->y, to.depth.at<float>(*px)));
    if (n.dot(R * sample.normal) < kMinCosine || std::abs(distance) >= limit_m) continue;
    const Eigen::Vector3d n_from = R.transpose() * n;
    Vector6d slope;  // derivative of the distance by the motion
    slope << p.cross(n) - sample.point.cross(n_from), n - n_from;
    const double weight = tukey_weight(distance, limit_m);
    out.squares += weight * slope * slope.transpose();
    out.sums += weight * slope * distance;
    out.weight += weight;
    out.distances.push_back(std::abs(distance));
  }
  return out;
}

/// Holds the views' points, which are drawn once: they stay where they are in their cameras.
struct Comparison {
  std::vector<std::vector<SurfaceSample>> samples;
  std::vector<std::vector<int>> neighbours;
  double radius = 0.1;  ///< about the object's, metres
};

Comparison make_comparison(const std::vector<DepthView>& views, const AlignmentSettings& settings) {
  Comparison out;
  out.neighbours = find_neighbours(views, settings.neighbours);
  double sum = 0.0;
  int count = 0;
  for (const DepthView& view : views) {
    out.samples.push_back(sample_view(view, settings.points_per_view));
    for (const SurfaceSample& sample : out.samples.back()) {
      sum += (view.T_camera_object.inverse() * sample.point).norm();
      ++count;
    }
  }
  if (count > 0) out.radius = std::max(0.01, sum / count);
  return out;
}

/// Returns one set of equations per view, from its points and its neighbours.
std::vector<Equations> compare_all(const std::vector<DepthView>& views, const Comparison& comparison,
                                   const AlignmentSettings& settings) {
  std::vector<Equations> equations(views.size());
  parallel_for(settings.threads, static_cast<int>(views.size()), [&](int i) {
    for (const int j : comparison.neighbours[i]) {
      equations[i].add(compare(comparison.samples[i], views[i], views[j], settings.max_pair_m));
    }
  });
  return equations;
}

/// Returns the step that lowers the distances. A rotation counts by the distance that it moves a point at the object's
/// radius, about its middle.
Eigen::Isometry3d solve(const Equations& equations, const Eigen::Vector3d& middle, double radius, double damping) {
  if (equations.weight <= 0.0) return Eigen::Isometry3d::Identity();
  // Rotations and shifts are nearly independent in coordinates about the object's middle.
  Matrix6d about_middle = Matrix6d::Identity();
  for (int k = 0; k < 3; ++k) {
    about_middle.block<3, 1>(3, k) = -Eigen::Vector3d::Unit(k).cross(middle);
  }
  Matrix6d squares = about_middle.transpose() * equations.squares * about_middle;
  squares.topLeftCorner<3, 3>().diagonal().array() += damping * equations.weight * radius * radius;
  squares.bottomRightCorner<3, 3>().diagonal().array() += damping * equations.weight;
  const Vector6d step = about_middle * squares.ldlt().solve(-(about_middle.transpose() * equations.sums));
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  const double angle = step.head<3>().norm();
  if (angle > 0.0) motion.linear() = Eigen::AngleAxisd(angle, step.head<3>() / angle).toRotationMatrix();
  motion.translation() = step.tail<3>();
  return motion;
}

Equations total(const std::vector<Equations>& parts) {
  Equations sum;
  for (const Equations& part : parts) sum.add(part);
  return sum;
}

}  // namespace

AlignmentError measure_alignment_error(const std::vector<DepthView>& views, const AlignmentSettings& settings) {
  Equations sum = total(compare_all(views, make_comparison(views, settings), settings));
  if (sum.distances.empty()) return {};
  const auto middle = sum.distances.begin() + static_cast<std::ptrdiff_t>(sum.distances.size() / 2);
  std::nth_element(sum.distances.begin(), middle, sum.distances.end());
  return {static_cast<int>(sum.distances.size()), *middle};
}

void align_views(std::vector<DepthView>& views, const AlignmentSettings& settings) {
  const Comparison comparison = make_comparison(views, settings);
  for (int k = 0; k < settings.iterations; ++k) {
    const Equations sum = total(compare_all(views, comparison, settings));
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const DepthView& view : views)
      middle += view.T_camera_object.translation() / static_cast<double>(views.size());
    const Eigen::Isometry3d motion = solve(sum, middle, comparison.radius, settings.damping);
    for (DepthView& view : views) view.T_camera_object = motion * view.T_camera_object;
  }
}

}  // namespace houghstream::fusion
