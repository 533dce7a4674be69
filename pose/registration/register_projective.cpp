#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "pose/registration/pair_block.hpp"
#include "pose/registration/registration.hpp"

namespace houghstream {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

constexpr int kLeastPairs = 12;    // for a step: twice the unknowns
constexpr double kDamping = 1e-3;  // of the mean curvature, holds turns that symmetric surfaces leave open

/// Weighted sums of products over the pairs. Arms are from the model's centre to the points, in its radius.
struct PairTotals {
  PairSums across = PairSums::Zero();  // of (arm x normal, normal, gap along the normal, 0)
  PairSums along = PairSums::Zero();   // of (arm, 1, gap, 0)
  int count = 0;
  double squares = 0.0;  // of the distances along the normals
};

/// Normal equations in a step (turn about the model's centre times its radius, shift), all in metres.
struct StepEquations {
  Matrix6d curvature = Matrix6d::Zero();  // lower triangle
  Vector6d gradient = Vector6d::Zero();
};

/// A block of points with the normals that go with them.
struct Visible {
  PairBlock block;
  std::array<Eigen::Vector3f, PairBlock::kSize> normals;

  void add(const Eigen::Vector3f& point, const Eigen::Vector3f& normal) {
    block.x[block.count] = point.x();
    block.y[block.count] = point.y();
    block.z[block.count] = point.z();
    normals[block.count++] = normal;
  }
};

PairRow across_row(const Eigen::Vector3f& a, const Eigen::Vector3f& n, float apart) {
  return {{a.y() * n.z() - a.z() * n.y(), a.z() * n.x() - a.x() * n.z(), a.x() * n.y() - a.y() * n.x(), n.x(), n.y(),
           n.z(), apart, 0.0F}};
}

/// Adds the block's pairs and empties it.
void add_pairs(const ObjectModel& model, const Eigen::Vector3f& centre, float limit_sq, Visible& visible,
               PairTotals& totals) {
  const PairBlock& block = visible.block;
  PairRows across;
  PairRows along;
  PairBlock::Values weights;
  std::size_t pairs = 0;
  for (std::size_t i = 0; i < block.count; ++i) {
    if (!(block.distance_sq[i] < limit_sq)) continue;
    const Eigen::Vector3f arm = (Eigen::Vector3f(block.x[i], block.y[i], block.z[i]) - centre) / model.radius;
    const Eigen::Vector3f gap(block.gap_x[i], block.gap_y[i], block.gap_z[i]);
    const float apart = gap.dot(visible.normals[i]);
    const float left = 1.0F - block.distance_sq[i] / limit_sq;
    across[pairs] = across_row(arm, visible.normals[i], apart);
    along[pairs] = {{arm.x(), arm.y(), arm.z(), 1.0F, gap.x(), gap.y(), gap.z(), 0.0F}};
    weights[pairs++] = left * left;  // Tukey's biweight
    totals.squares += static_cast<double>(apart * apart);
  }
  add_products(across, weights, pairs, totals.across);
  add_products(along, weights, pairs, totals.along);
  totals.count += static_cast<int>(pairs);
  visible.block.count = 0;
}

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& a) {
  Eigen::Matrix3d out;
  out << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return out;
}

/// Of the sum of weight ((gap along the normal)^2 + point_weight gap^2).
StepEquations equations_of(const PairTotals& totals, double point_weight) {
  const Eigen::Matrix<double, 8, 8> along = point_weight * totals.along.cast<double>();
  const Eigen::Matrix3d arms = along.topLeftCorner<3, 3>();
  const Eigen::Matrix3d moments = along.block<3, 3>(0, 4);  // arm times gap
  StepEquations equations;
  equations.curvature = totals.across.topLeftCorner<6, 6>().cast<double>();
  equations.curvature.topLeftCorner<3, 3>() += arms.trace() * Eigen::Matrix3d::Identity() - arms;
  equations.curvature.bottomLeftCorner<3, 3>() -= cross_matrix(along.block<3, 1>(0, 3));
  equations.curvature.bottomRightCorner<3, 3>().diagonal().array() += along(3, 3);
  equations.gradient = totals.across.block<6, 1>(0, 6).cast<double>();
  equations.gradient.head<3>() +=
      Eigen::Vector3d(moments(1, 2) - moments(2, 1), moments(2, 0) - moments(0, 2), moments(0, 1) - moments(1, 0));
  equations.gradient.tail<3>() += along.block<3, 1>(4, 3);
  return equations;
}

/// Of the first `count` points of the view nearest to the pose.
PairTotals pair_up(const SeenObject& seen, const Eigen::Isometry3d& T_camera_object, std::size_t count,
                   const PairSearch& search) {
  const ObjectModel& model = seen.model;
  const ModelView& view = nearest_view(model, T_camera_object);
  const Eigen::Isometry3f T = T_camera_object.cast<float>();
  const Eigen::Vector3f centre = T * model.centre;
  const std::size_t used = std::min(count, view.points.size());
  Visible visible;
  PairTotals totals;
  for (std::size_t i = 0; i < used; ++i) {
    const Eigen::Vector3f point = T * view.points[i];
    const Eigen::Vector3f normal = T.linear() * view.normals[i];
    const bool in_sight = point.z() > 0.0F && normal.dot(point) < 0.0F;  // not turned away since the view was chosen
    if (in_sight) visible.add(point, normal);
    if (visible.block.count < PairBlock::kSize && i + 1 < used) continue;
    find_gaps(seen.frame, search, visible.block);
    add_pairs(model, centre, search.distance_m * search.distance_m, visible, totals);
  }
  return totals;
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

RegistrationResult register_projective(const SeenObject& seen, const Eigen::Isometry3d& T_camera_object,
                                       const RegistrationStage& stage, const RegistrationSettings& settings) {
  const ObjectModel& model = seen.model;
  RegistrationResult result;
  result.T_camera_object = T_camera_object;
  const auto points = static_cast<std::size_t>(stage.points);
  const double shrink =
      std::pow(stage.end_distance_m / stage.start_distance_m, 1.0 / std::max(1, stage.iterations - 1));
  double distance = stage.start_distance_m;
  for (; result.iterations < stage.iterations; ++result.iterations) {
    const PairTotals pairs =
        pair_up(seen, result.T_camera_object, points, {static_cast<float>(distance), stage.search_steps});
    result.converged = false;
    if (pairs.count < kLeastPairs) break;
    const StepEquations equations = equations_of(pairs, settings.point_weight);
    result.converged = take_step(equations, model, result.T_camera_object) < settings.converged_m;
    if (result.converged && distance <= stage.end_distance_m * 1.01) break;
    distance = std::max(distance * shrink, stage.end_distance_m);
  }
  const PairTotals last =
      pair_up(seen, result.T_camera_object, points, {static_cast<float>(stage.end_distance_m), stage.search_steps});
  const std::size_t used = std::min(points, nearest_view(model, result.T_camera_object).points.size());
  result.inliers = last.count;
  result.inlier_fraction = static_cast<float>(last.count) / static_cast<float>(used);
  result.residual = static_cast<float>(std::sqrt(last.squares / last.count));  // 0/0 is NaN
  return result;
}

}  // namespace houghstream
