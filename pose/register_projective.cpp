#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "pose/registration.hpp"

namespace houghstream {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr int kSearchSteps = 2;    // lookups to each side of a point's pixel
constexpr int kLeastPairs = 12;    // for a step: twice the unknowns
constexpr double kDamping = 1e-3;  // of the mean curvature, holds turns that symmetric surfaces leave open

/// Normal equations in a step (turn about the model's centre times its radius, shift), all in metres.
struct StepEquations {
  Matrix6d curvature = Matrix6d::Zero();  // lower triangle
  Vector6d gradient = Vector6d::Zero();
  int pairs = 0;
  double squares = 0.0;  // of the distances along the normals
};

/// The measured point nearest to `point` among a lattice of pixels that reaches `distance` to each side.
bool nearest_measured(const RgbdFrame& frame, const Eigen::Vector3d& point, double distance, Eigen::Vector3d& nearest) {
  const Eigen::Vector2d pixel = frame.camera.project(point);
  const double reach_px = distance / frame.camera.metres_per_px(point.z());
  const int stride = std::max(1, static_cast<int>(reach_px / kSearchSteps));
  const int reach = stride * kSearchSteps;
  const bool inside =
      pixel.x() >= 0.0 && pixel.y() >= 0.0 && pixel.x() <= frame.depth.cols - 1 && pixel.y() <= frame.depth.rows - 1;
  if (!inside) return false;
  const int u = static_cast<int>(std::lround(pixel.x()));
  const int v = static_cast<int>(std::lround(pixel.y()));
  double best_sq = distance * distance;
  bool found = false;
  for (int y = v - reach; y <= v + reach; y += stride) {
    if (y < 0 || y >= frame.depth.rows) continue;
    const float* depth = frame.depth.ptr<float>(y);
    for (int x = std::max(u - reach, u % stride); x <= std::min(u + reach, frame.depth.cols - 1); x += stride) {
      if (!(std::abs(depth[x] - point.z()) < distance)) continue;
      const Eigen::Vector3d measured = frame.camera.backproject(x, y, depth[x]);
      const double distance_sq = (measured - point).squaredNorm();
      if (distance_sq >= best_sq) continue;
      best_sq = distance_sq;
      nearest = measured;
      found = true;
    }
  }
  return found;
}

void add_row(StepEquations& equations, const Vector6d& row, double residual, double weight) {
  equations.curvature.selfadjointView<Eigen::Lower>().rankUpdate(row, weight);
  equations.gradient += weight * residual * row;
}

StepEquations pair_up(const RgbdFrame& frame, const ObjectModel& model, const Eigen::Isometry3d& T_camera_object,
                      std::size_t count, double distance, double point_weight) {
  const ModelView& view = nearest_view(model, T_camera_object);
  const Eigen::Vector3d centre = T_camera_object * model.centre.cast<double>();
  StepEquations equations;
  for (std::size_t i = 0; i < std::min(count, view.points.size()); ++i) {
    const Eigen::Vector3d point = T_camera_object * view.points[i].cast<double>();
    const Eigen::Vector3d normal = T_camera_object.linear() * view.normals[i].cast<double>();
    Eigen::Vector3d measured;
    if (!(point.z() > 0.0) || normal.dot(point) >= 0.0) continue;  // turned away since the view was chosen
    if (!nearest_measured(frame, point, distance, measured)) continue;
    const Eigen::Vector3d gap = measured - point;
    const double across = gap.dot(normal);
    const double ratio_sq = gap.squaredNorm() / (distance * distance);
    const double weight = (1.0 - ratio_sq) * (1.0 - ratio_sq);  // Tukey's biweight
    ++equations.pairs;
    equations.squares += across * across;
    const Eigen::Vector3d arm = (point - centre) / model.radius;
    Vector6d row;
    row << arm.cross(normal), normal;
    add_row(equations, row, across, weight);
    for (int axis = 0; axis < 3; ++axis) {
      row << arm.cross(Eigen::Vector3d::Unit(axis)), Eigen::Vector3d::Unit(axis);
      add_row(equations, row, gap[axis], weight * point_weight);
    }
  }
  return equations;
}

/// Moves the model by the damped Gauss-Newton step and gives the step's length, metres.
double take_step(StepEquations& equations, const ObjectModel& model, Eigen::Isometry3d& T_camera_object) {
  const double damping = kDamping * equations.curvature.trace() / 6.0;
  equations.curvature.diagonal().array() += damping;
  const Vector6d step = equations.curvature.selfadjointView<Eigen::Lower>().ldlt().solve(equations.gradient);
  if (!step.allFinite()) return 0.0;
  const Eigen::Vector3d centre = T_camera_object * model.centre.cast<double>();
  const Eigen::Vector3d turn = step.head<3>() / model.radius;
  const double angle = turn.norm();
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.translate(centre + step.tail<3>());
  if (angle > 0.0) motion.rotate(Eigen::AngleAxisd(angle, turn / angle));
  motion.translate(-centre);
  T_camera_object = motion * T_camera_object;
  return step.norm();
}

}  // namespace

RegistrationResult register_projective(const RgbdFrame& frame, const ObjectModel& model,
                                       const Eigen::Isometry3d& T_camera_object, const RegistrationStage& stage,
                                       const RegistrationSettings& settings) {
  RegistrationResult result;
  result.T_camera_object = T_camera_object;
  const auto points = static_cast<std::size_t>(stage.points);
  const double shrink =
      std::pow(stage.end_distance_m / stage.start_distance_m, 1.0 / std::max(1, stage.iterations - 1));
  double distance = stage.start_distance_m;
  for (; result.iterations < stage.iterations; ++result.iterations) {
    StepEquations equations = pair_up(frame, model, result.T_camera_object, points, distance, settings.point_weight);
    result.converged = false;
    if (equations.pairs < kLeastPairs) break;
    result.converged = take_step(equations, model, result.T_camera_object) < settings.converged_m;
    if (result.converged && distance <= stage.end_distance_m * 1.01) break;
    distance = std::max(distance * shrink, stage.end_distance_m);
  }
  const StepEquations last =
      pair_up(frame, model, result.T_camera_object, points, stage.end_distance_m, settings.point_weight);
  const std::size_t used = std::min(points, nearest_view(model, result.T_camera_object).points.size());
  result.inliers = last.pairs;
  result.inlier_fraction = static_cast<float>(last.pairs) / static_cast<float>(used);
  result.residual = static_cast<float>(std::sqrt(last.squares / last.pairs));  // 0/0 is NaN
  return result;
}

}  // namespace houghstream
