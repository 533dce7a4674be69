#include "pose/registration/depth_equations.hpp"

#include <algorithm>
#include <array>

namespace houghstream {
namespace {

/// A block of points with the normals that go with them.
struct VisiblePoints {
  CorrespondenceBlock block;
  std::array<Eigen::Vector3f, CorrespondenceBlock::kSize> normals;

  void add(const Eigen::Vector3f& point, const Eigen::Vector3f& normal) {
    block.x[block.count] = point.x();
    block.y[block.count] = point.y();
    block.z[block.count] = point.z();
    normals[block.count++] = normal;
  }
};

/// Returns the row of the point-to-plane Jacobian, (arm x normal, normal), followed by the residual along the normal.
ResidualRow point_to_plane_row(const Eigen::Vector3f& a, const Eigen::Vector3f& n, float normal_distance) {
  return {{a.y() * n.z() - a.z() * n.y(), a.z() * n.x() - a.x() * n.z(), a.x() * n.y() - a.y() * n.x(), n.x(), n.y(),
           n.z(), normal_distance, 0.0F}};
}

/// Adds the block's correspondences under Tukey's weights and the given ones, and empties the block.
void accumulate_correspondences(const ObjectModel& model, const Eigen::Vector3f& centre, float limit_sq,
                                const PairWeight& weight, VisiblePoints& visible, CorrespondenceSums& totals) {
  const CorrespondenceBlock& block = visible.block;
  ResidualRows plane_rows;
  ResidualRows point_rows;
  CorrespondenceBlock::Values weights;
  std::size_t pairs = 0;
  for (std::size_t i = 0; i < block.count; ++i) {
    if (!(block.distance_sq[i] < limit_sq)) continue;
    const Eigen::Vector3f point(block.x[i], block.y[i], block.z[i]);
    const Eigen::Vector3f arm = (point - centre) / model.radius;
    const Eigen::Vector3f residual(block.residual_x[i], block.residual_y[i], block.residual_z[i]);
    const float normal_distance = residual.dot(visible.normals[i]);
    const float tukey = 1.0F - block.distance_sq[i] / limit_sq;
    plane_rows[pairs] = point_to_plane_row(arm, visible.normals[i], normal_distance);
    point_rows[pairs] = {{arm.x(), arm.y(), arm.z(), 1.0F, residual.x(), residual.y(), residual.z(), 0.0F}};
    const float given = weight ? weight(point + residual) : 1.0F;
    weights[pairs++] = given * tukey * tukey;  // Tukey's biweight
    totals.squares += static_cast<double>(normal_distance * normal_distance);
  }
  accumulate_outer_products(plane_rows, weights, pairs, totals.across);
  accumulate_outer_products(point_rows, weights, pairs, totals.along);
  totals.count += static_cast<int>(pairs);
  visible.block.count = 0;
}

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& a) {
  Eigen::Matrix3d out;
  out << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return out;
}

}  // namespace

CorrespondenceSums sum_correspondences(const ObjectObservation& observation, const Eigen::Isometry3d& T_camera_object,
                                       std::size_t count, const CorrespondenceSearch& search,
                                       const PairWeight& weight) {
  const ObjectModel& model = observation.model;
  const ModelView& view = nearest_view(model, T_camera_object);
  const Eigen::Isometry3f T = T_camera_object.cast<float>();
  const Eigen::Vector3f centre = T * model.centre;
  const std::size_t used = std::min(count, view.points.size());
  VisiblePoints visible;
  CorrespondenceSums totals;
  for (std::size_t i = 0; i < used; ++i) {
    const Eigen::Vector3f point = T * view.points[i];
    const Eigen::Vector3f normal = T.linear() * view.normals[i];
    const bool is_visible = point.z() > 0.0F && normal.dot(point) < 0.0F;  // not turned away since the view was chosen
    if (is_visible) visible.add(point, normal);
    if (visible.block.count < CorrespondenceBlock::kSize && i + 1 < used) continue;
    find_correspondences(observation.frame, search, visible.block);
    accumulate_correspondences(model, centre, search.distance_m * search.distance_m, weight, visible, totals);
  }
  return totals;
}

MotionEquations build_equations(const CorrespondenceSums& totals, double point_weight) {
  const Eigen::Matrix<double, 8, 8> along = point_weight * totals.along.cast<double>();
  const Eigen::Matrix3d arms = along.topLeftCorner<3, 3>();
  const Eigen::Matrix3d moments = along.block<3, 3>(0, 4);  // arm times residual
  MotionEquations equations;
  equations.hessian = totals.across.topLeftCorner<6, 6>().cast<double>();
  equations.hessian.topLeftCorner<3, 3>() += arms.trace() * Eigen::Matrix3d::Identity() - arms;
  equations.hessian.bottomLeftCorner<3, 3>() -= cross_matrix(along.block<3, 1>(0, 3));
  equations.hessian.bottomRightCorner<3, 3>().diagonal().array() += along(3, 3);
  equations.gradient = totals.across.block<6, 1>(0, 6).cast<double>();
  equations.gradient.head<3>() +=
      Eigen::Vector3d(moments(1, 2) - moments(2, 1), moments(2, 0) - moments(0, 2), moments(0, 1) - moments(1, 0));
  equations.gradient.tail<3>() += along.block<3, 1>(4, 3);
  return equations;
}

double move_by_step(const Vector6d& step, const ObjectModel& model, Eigen::Isometry3d& T_camera_object) {
  const Eigen::Vector3d centre = T_camera_object * model.centre.cast<double>();
  const Eigen::Vector3d rotation = step.head<3>() / model.radius;
  const double angle = rotation.norm();
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.translate(centre + step.tail<3>());
  if (angle > 0.0) motion.rotate(Eigen::AngleAxisd(angle, rotation / angle));
  motion.translate(-centre);
  T_camera_object = motion * T_camera_object;
  return step.norm();
}

}  // namespace houghstream
