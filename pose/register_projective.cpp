#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "pose/registration.hpp"

namespace houghstream {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector8f = Eigen::Matrix<float, 8, 1>;
using Matrix8f = Eigen::Matrix<float, 8, 8>;

constexpr int kLeastPairs = 12;    // for a step: twice the unknowns
constexpr double kDamping = 1e-3;  // of the mean curvature, holds turns that symmetric surfaces leave open

/// What the pairs pull, as weighted sums of products: single precision and a width of eight suit vector units. Arms are
/// from the model's centre to the points, in its radius.
struct Pull {
  Matrix8f across = Matrix8f::Zero();  // of (arm x normal, normal, gap along the normal, 0)
  Matrix8f along = Matrix8f::Zero();   // of (arm, 1, gap, 0)
  int pairs = 0;
  double squares = 0.0;  // of the distances along the normals
};

/// Normal equations in a step (turn about the model's centre times its radius, shift), all in metres.
struct StepEquations {
  Matrix6d curvature = Matrix6d::Zero();  // lower triangle
  Vector6d gradient = Vector6d::Zero();
};

/// Rays of pixels with z = 1: that of (0,0), and the steps between neighbours.
struct Rays {
  explicit Rays(const Camera& camera)
      : first(camera.backproject(0, 0, 1.0).cast<float>()),
        step((camera.backproject(1, 1, 1.0) - camera.backproject(0, 0, 1.0)).cast<float>()) {}
  Eigen::Vector3f first;
  Eigen::Vector3f step;
};

/// The gap to the measured point nearest to `p` among a lattice of pixels that reaches `distance` to each side.
bool nearest_measured(const RgbdFrame& frame, const Rays& rays, const Eigen::Vector3f& p, float distance, int steps,
                      Eigen::Vector3f& gap) {
  const Eigen::Vector2f pixel = frame.camera.project_single(p) + Eigen::Vector2f::Constant(0.5F);
  const bool inside = pixel.x() >= 0.5F && pixel.y() >= 0.5F && pixel.x() < static_cast<float>(frame.depth.cols) &&
                      pixel.y() < static_cast<float>(frame.depth.rows);
  if (!inside) return false;
  const int stride = std::max(1, static_cast<int>(distance / (rays.step.x() * p.z() * static_cast<float>(steps))));
  const int u = static_cast<int>(pixel.x());
  const int v = static_cast<int>(pixel.y());
  const auto least = [stride, steps](int at) { return -std::min(steps, at / stride); };
  const auto most = [stride, steps](int at, int size) { return std::min(steps, (size - 1 - at) / stride); };
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

void add_product(Matrix8f& sum, const std::array<float, 8>& row, float weight) {
  const Eigen::Map<const Vector8f> r(row.data());
  sum.noalias() += (weight * r) * r.transpose();
}

void add_pair(Pull& pull, const Eigen::Vector3f& arm, const Eigen::Vector3f& normal, const Eigen::Vector3f& gap,
              float weight) {
  const float apart = gap.dot(normal);
  const Eigen::Vector3f& a = arm;
  const Eigen::Vector3f& n = normal;
  const std::array<float, 8> across{a.y() * n.z() - a.z() * n.y(),
                                    a.z() * n.x() - a.x() * n.z(),
                                    a.x() * n.y() - a.y() * n.x(),
                                    n.x(),
                                    n.y(),
                                    n.z(),
                                    apart,
                                    0.0F};
  const std::array<float, 8> along{a.x(), a.y(), a.z(), 1.0F, gap.x(), gap.y(), gap.z(), 0.0F};
  add_product(pull.across, across, weight);
  add_product(pull.along, along, weight);
  ++pull.pairs;
  pull.squares += static_cast<double>(apart * apart);
}

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& a) {
  Eigen::Matrix3d out;
  out << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return out;
}

/// Of the sum of weight ((gap along the normal)^2 + point_weight gap^2).
StepEquations equations_of(const Pull& pull, double point_weight) {
  const Eigen::Matrix<double, 8, 8> along = point_weight * pull.along.cast<double>();
  const Eigen::Matrix3d arms = along.topLeftCorner<3, 3>();
  const Eigen::Matrix3d moments = along.block<3, 3>(0, 4);  // arm times gap
  StepEquations equations;
  equations.curvature = pull.across.topLeftCorner<6, 6>().cast<double>();
  equations.curvature.topLeftCorner<3, 3>() += arms.trace() * Eigen::Matrix3d::Identity() - arms;
  equations.curvature.bottomLeftCorner<3, 3>() -= cross_matrix(along.block<3, 1>(0, 3));
  equations.curvature.bottomRightCorner<3, 3>().diagonal().array() += along(3, 3);
  equations.gradient = pull.across.block<6, 1>(0, 6).cast<double>();
  equations.gradient.head<3>() +=
      Eigen::Vector3d(moments(1, 2) - moments(2, 1), moments(2, 0) - moments(0, 2), moments(0, 1) - moments(1, 0));
  equations.gradient.tail<3>() += along.block<3, 1>(4, 3);
  return equations;
}

Pull pair_up(const RgbdFrame& frame, const ObjectModel& model, const Eigen::Isometry3d& T_camera_object,
             std::size_t count, double distance, int steps) {
  const ModelView& view = nearest_view(model, T_camera_object);
  const Eigen::Isometry3f T = T_camera_object.cast<float>();
  const Eigen::Vector3f centre = T * model.centre;
  const auto reach = static_cast<float>(distance);
  const Rays rays(frame.camera);
  Pull pull;
  for (std::size_t i = 0; i < std::min(count, view.points.size()); ++i) {
    const Eigen::Vector3f point = T * view.points[i];
    const Eigen::Vector3f normal = T.linear() * view.normals[i];
    if (!(point.z() > 0.0F) || normal.dot(point) >= 0.0F) continue;  // turned away since the view was chosen
    Eigen::Vector3f gap = Eigen::Vector3f::Zero();
    if (!nearest_measured(frame, rays, point, reach, steps, gap)) continue;
    const float left = 1.0F - gap.squaredNorm() / (reach * reach);
    add_pair(pull, (point - centre) / model.radius, normal, gap, left * left);  // Tukey's biweight
  }
  return pull;
}

/// Moves the model by the damped Gauss-Newton step and gives the step's length, metres.
double take_step(StepEquations equations, const ObjectModel& model, Eigen::Isometry3d& T_camera_object) {
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
    const Pull pull = pair_up(frame, model, result.T_camera_object, points, distance, stage.search_steps);
    result.converged = false;
    if (pull.pairs < kLeastPairs) break;
    const StepEquations equations = equations_of(pull, settings.point_weight);
    result.converged = take_step(equations, model, result.T_camera_object) < settings.converged_m;
    if (result.converged && distance <= stage.end_distance_m * 1.01) break;
    distance = std::max(distance * shrink, stage.end_distance_m);
  }
  const Pull last = pair_up(frame, model, result.T_camera_object, points, stage.end_distance_m, stage.search_steps);
  const std::size_t used = std::min(points, nearest_view(model, result.T_camera_object).points.size());
  result.inliers = last.pairs;
  result.inlier_fraction = static_cast<float>(last.pairs) / static_cast<float>(used);
  result.residual = static_cast<float>(std::sqrt(last.squares / last.pairs));  // 0/0 is NaN
  return result;
}

}  // namespace houghstream
