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

/// Rays of pixels with z = 1: that of (0,0), and the steps between neighbours.
struct Rays {
  explicit Rays(const Camera& camera)
      : first(camera.backproject(0, 0, 1.0).cast<float>()),
        step((camera.backproject(1, 1, 1.0) - camera.backproject(0, 0, 1.0)).cast<float>()) {}
  Eigen::Vector3f first;
  Eigen::Vector3f step;
};

/// The gap to the measured point nearest to `point` among a lattice of pixels that reaches `distance` to each side.
bool nearest_measured(const RgbdFrame& frame, const Rays& rays, const Eigen::Vector3d& point, float distance,
                      Eigen::Vector3f& gap) {
  const Eigen::Vector2d pixel = frame.camera.project(point);
  const bool inside =
      pixel.x() >= 0.0 && pixel.y() >= 0.0 && pixel.x() <= frame.depth.cols - 1 && pixel.y() <= frame.depth.rows - 1;
  if (!inside) return false;
  const Eigen::Vector3f p = point.cast<float>();
  const int stride = std::max(1, static_cast<int>(distance / (rays.step.x() * p.z()) / kSearchSteps));
  const int u = static_cast<int>(std::lround(pixel.x()));
  const int v = static_cast<int>(std::lround(pixel.y()));
  const auto least = [stride](int at) { return -std::min(kSearchSteps, at / stride); };
  const auto most = [stride](int at, int size) { return std::min(kSearchSteps, (size - 1 - at) / stride); };
  float best_sq = distance * distance;
  const float limit_sq = best_sq;
  for (int j = least(v); j <= most(v, frame.depth.rows); ++j) {
    const int y = v + j * stride;
    const float* depth = frame.depth.ptr<float>(y);
    const float ray_y = rays.first.y() + rays.step.y() * static_cast<float>(y);
    for (int i = least(u); i <= most(u, frame.depth.cols); ++i) {
      const int x = u + i * stride;
      const float z = depth[x];  // NaN fails the comparison below
      const Eigen::Vector3f here(z * (rays.first.x() + rays.step.x() * static_cast<float>(x)) - p.x(),
                                 z * ray_y - p.y(), z - p.z());
      const float distance_sq = here.squaredNorm();
      if (!(distance_sq < best_sq)) continue;
      best_sq = distance_sq;
      gap = here;
    }
  }
  return best_sq < limit_sq;
}

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& a) {
  Eigen::Matrix3d out;
  out << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return out;
}

/// Adds the pull of one pair: gap^T W gap with W = weight (n n^T + point_weight I).
void add_pair(StepEquations& equations, const Eigen::Vector3d& arm, const Eigen::Vector3d& gap,
              const Eigen::Matrix3d& pull) {
  const Eigen::Matrix3d turning = cross_matrix(arm);
  const Eigen::Matrix3d turned = turning * pull;
  equations.curvature.topLeftCorner<3, 3>() += turned * turning.transpose();
  equations.curvature.bottomLeftCorner<3, 3>() += turned.transpose();
  equations.curvature.bottomRightCorner<3, 3>() += pull;
  equations.gradient.head<3>() += turned * gap;
  equations.gradient.tail<3>() += pull * gap;
}

StepEquations pair_up(const RgbdFrame& frame, const ObjectModel& model, const Eigen::Isometry3d& T_camera_object,
                      std::size_t count, double distance, double point_weight) {
  const ModelView& view = nearest_view(model, T_camera_object);
  const Eigen::Vector3d centre = T_camera_object * model.centre.cast<double>();
  const Rays rays(frame.camera);
  StepEquations equations;
  for (std::size_t i = 0; i < std::min(count, view.points.size()); ++i) {
    const Eigen::Vector3d point = T_camera_object * view.points[i].cast<double>();
    const Eigen::Vector3d normal = T_camera_object.linear() * view.normals[i].cast<double>();
    if (!(point.z() > 0.0) || normal.dot(point) >= 0.0) continue;  // turned away since the view was chosen
    Eigen::Vector3f measured_gap = Eigen::Vector3f::Zero();
    if (!nearest_measured(frame, rays, point, static_cast<float>(distance), measured_gap)) continue;
    const Eigen::Vector3d gap = measured_gap.cast<double>();
    const double across = gap.dot(normal);
    const double left = 1.0 - gap.squaredNorm() / (distance * distance);
    const double weight = left * left;  // Tukey's biweight
    ++equations.pairs;
    equations.squares += across * across;
    Eigen::Matrix3d pull = weight * normal * normal.transpose();
    pull.diagonal().array() += weight * point_weight;
    add_pair(equations, (point - centre) / model.radius, gap, pull);
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
