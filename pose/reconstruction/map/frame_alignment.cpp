#include "pose/reconstruction/map/frame_alignment.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "pose/motion/twist.hpp"

namespace houghstream::reconstruction {
namespace {

/// Normal equations and counts of one evaluation of all points.
struct NormalEquations {
  Matrix6 hessian = Matrix6::Zero();
  Vector6 gradient = Vector6::Zero();
  int pairs = 0, visible = 0, photometric_pairs = 0;
  double depth_sq = 0.0, photometric_sq = 0.0;

  void add(const Vector6& row, double residual, double weight) {
    hessian.noalias() += weight * row * row.transpose();
    gradient.noalias() += (weight * residual) * row;
  }
};

/// Interpolates the depth between pixels; returns that of the nearest pixel at an edge, NaN where there is none.
float depth_between(const cv::Mat& depth, float u, float v) {
  const int x = static_cast<int>(u);
  const int y = static_cast<int>(v);
  const float* above = depth.ptr<float>(y) + x;
  const float* below = depth.ptr<float>(y + 1) + x;
  const float low = std::min(std::min(above[0], above[1]), std::min(below[0], below[1]));
  const float high = std::max(std::max(above[0], above[1]), std::max(below[0], below[1]));
  const float du = u - static_cast<float>(x);
  const float dv = v - static_cast<float>(y);
  const float sum = above[0] + above[1] + below[0] + below[1];
  if (!(high - low < 0.02F * low) || !std::isfinite(sum)) return (dv < 0.5F ? above : below)[du < 0.5F ? 0 : 1];
  return (1 - dv) * ((1 - du) * above[0] + du * above[1]) + dv * ((1 - du) * below[0] + du * below[1]);
}

/// Holds the intensity between pixels and its gradient.
struct IntensitySample {
  float value, slope_u, slope_v;
};
IntensitySample interpolate_intensity(const cv::Mat& intensity, float u, float v) {
  const int x = static_cast<int>(u);
  const int y = static_cast<int>(v);
  const float du = u - static_cast<float>(x);
  const float dv = v - static_cast<float>(y);
  const float* a = intensity.ptr<float>(y) + x;
  const float* b = intensity.ptr<float>(y + 1) + x;
  const float above = a[0] + du * (a[1] - a[0]);
  const float below = b[0] + du * (b[1] - b[0]);
  return {above + dv * (below - above), (1 - dv) * (a[1] - a[0]) + dv * (b[1] - b[0]), below - above};
}

/// Returns Tukey's weight of a residual in standard deviations.
double tukey(double r) {
  constexpr double kLimit_sq = 4.685 * 4.685;
  const double rest = 1.0 - r * r / kLimit_sq;
  return rest > 0.0 ? rest * rest : 0.0;
}

class ResidualEvaluator {
  static constexpr double kMinSlope = 0.15;  // intensity per pixel
  static constexpr double kNear_m = 0.6;     // distance from the world's origin, at which the object is

 public:
  ResidualEvaluator(const FrameLevel& frame, const Eigen::Isometry3d& T, int level, const AlignmentLimits& limits)
      : frame_(frame),
        R_(T.linear().cast<float>()),
        t_(T.translation().cast<float>()),
        gate_(limits.gate_m * static_cast<double>(1 << level)),
        limits_(limits) {}

  void add(const SurfacePoint& point, NormalEquations& equations) const {
    const Eigen::Vector3f p = R_ * point.point + t_;
    if (!(p.z() > 0.1F)) return;
    const Eigen::Vector2f px = frame_.camera.project_single(p);
    if (!(px.x() >= 1.0F && px.y() >= 1.0F && px.x() < static_cast<float>(frame_.depth.cols - 2) &&
          px.y() < static_cast<float>(frame_.depth.rows - 2)))
      return;
    const double sigma = depth_sigma(p.z());
    const double gate = gate_ + 3.0 * sigma;
    const float z = depth_between(frame_.depth, px.x(), px.y());
    if (!std::isfinite(z)) return;
    const double behind = p.z() - z;
    if (behind > gate) return;  // hidden
    ++equations.visible;
    if (behind < -gate) return;  // a free-space violation
    const Eigen::Vector3f n = R_ * point.normal;
    const float facing = -n.dot(p) / p.norm();
    if (facing < 0.05F) return;
    const double residual = n.dot(p) * (z / p.z() - 1.0F);
    const double weight = tukey(residual / (1.5 * sigma + 0.3 * gate_));
    if (weight > 0.0) {
      ++equations.pairs;
      equations.depth_sq += residual * residual;
      Vector6 row;
      row << -point.normal.cast<double>(), -point.point.cross(point.normal).cast<double>();
      equations.add(row, residual, weight * std::min(1.0F, 2.0F * facing) / (sigma * sigma));
    }
    if (limits_.use_photometric) add_photometric(point, p, px, equations);
  }

 private:
  void add_photometric(const SurfacePoint& point, const Eigen::Vector3f& p, const Eigen::Vector2f& px,
                       NormalEquations& equations) const {
    const bool is_static =
        !frame_.static_mask.empty() && frame_.static_mask.at<std::uint8_t>(cvRound(px.y()), cvRound(px.x())) != 0;
    if (is_static || !std::isfinite(point.intensity)) return;
    const IntensitySample sample = interpolate_intensity(frame_.intensity, px.x(), px.y());
    const double residual = sample.value - point.intensity;
    const double weight = tukey(residual / (2.0 * limits_.photometric_sigma));
    ++equations.photometric_pairs;
    equations.photometric_sq += std::min(residual * residual, 1.0);
    if (weight <= 0.0) return;
    const float a = sample.slope_u * static_cast<float>(frame_.camera.fx) / p.z();
    const float b = sample.slope_v * static_cast<float>(frame_.camera.fy) / p.z();
    const Eigen::Vector3f in_world = R_.transpose() * Eigen::Vector3f(a, b, -(a * p.x() + b * p.y()) / p.z());
    Vector6 row;
    row << in_world.cast<double>(), point.point.cross(in_world).cast<double>();
    // Points far from the object constrain its pose little, and their texture often repeats: wallpaper, tiles.
    const double far = point.point.norm() / kNear_m;
    // Small gradients are shading and highlights, which do not move with the surface.
    const double slope_sq = sample.slope_u * sample.slope_u + sample.slope_v * sample.slope_v;
    const double edge = slope_sq / (slope_sq + kMinSlope * kMinSlope);
    equations.add(row, residual,
                  edge * weight / (limits_.photometric_sigma * limits_.photometric_sigma * (1.0 + far * far)));
  }

  const FrameLevel& frame_;
  Eigen::Matrix3f R_;
  Eigen::Vector3f t_;
  double gate_;
  const AlignmentLimits& limits_;
};

void add_plane(const PlanePrior& plane, const Eigen::Isometry3d& T, NormalEquations& equations) {
  const Eigen::Vector3d up = T.linear().transpose() * plane.normal;  // should be z
  const double angle = 1.0 / (plane.sigma_rad * plane.sigma_rad);
  Vector6 row = Vector6::Zero();
  row[4] = 1.0;
  equations.add(row, -up.x(), angle);
  row.setZero();
  row[3] = -1.0;
  equations.add(row, -up.y(), angle);
  row.setZero();
  row.head<3>() = up;
  equations.add(row, plane.normal.dot(T.translation()) + plane.offset, 1.0 / (plane.sigma_m * plane.sigma_m));
}

/// Computes bearing_error() of a landmark at p, which is in front of the camera.
double bearing_error_at(const Eigen::Vector3d& p, const LandmarkObservation& landmark) {
  return (p.head<2>() / p.z() - landmark.in_camera.head<2>() / landmark.in_camera.z()).norm();
}

/// Adds a landmark. Its bearing hardly depends on its depth, so far landmarks constrain the camera's rotation.
void add_landmark(const LandmarkObservation& landmark, const Eigen::Isometry3d& T, NormalEquations& equations) {
  constexpr double kSigma = 0.003;  // error of a bearing: one to two pixels
  const Eigen::Vector3d p = T * landmark.in_world;
  if (!(p.z() > 0.1)) return;
  const double weight = tukey(bearing_error_at(p, landmark) / (2.0 * kSigma)) / (kSigma * kSigma);
  if (weight <= 0.0) return;
  for (const int axis : {0, 1}) {
    Eigen::Vector3d gradient = Eigen::Vector3d::Unit(axis) / p.z();
    gradient.z() = -p[axis] / (p.z() * p.z());
    const Eigen::Vector3d in_world = T.linear().transpose() * gradient;
    Vector6 row;
    row << in_world, landmark.in_world.cross(in_world);
    equations.add(row, p[axis] / p.z() - landmark.in_camera[axis] / landmark.in_camera.z(), weight);
  }
}

NormalEquations build_normal_equations(const std::vector<SurfacePoint>& points, const FrameLevel& frame,
                                       const Eigen::Isometry3d& T, int level, const AlignmentLimits& limits) {
  NormalEquations equations;
  const ResidualEvaluator evaluator(frame, T, level, limits);
  for (const SurfacePoint& point : points) evaluator.add(point, equations);
  return equations;
}

}  // namespace

double bearing_error(const LandmarkObservation& landmark, const Eigen::Isometry3d& T_camera_world) {
  const Eigen::Vector3d p = T_camera_world * landmark.in_world;
  return p.z() > 0.0 ? bearing_error_at(p, landmark) : std::numeric_limits<double>::infinity();
}

Alignment align_frame(const LevelPoints& points, const FrameLevels& frame, const Eigen::Isometry3d& T_camera_world,
                      const PoseConstraints& constraints, const AlignmentLimits& limits) {
  constexpr int kMin = 40;
  Alignment out;
  out.T_camera_world = T_camera_world;
  NormalEquations equations;
  for (int level = limits.coarsest; level >= limits.finest; --level) {
    const auto l = static_cast<std::size_t>(level);
    for (int i = 0; i <= limits.iterations; ++i) {
      equations = build_normal_equations(points[l], frame.levels[l], out.T_camera_world, level, limits);
      if (equations.pairs < kMin) break;
      if (constraints.plane) add_plane(*constraints.plane, out.T_camera_world, equations);
      for (const LandmarkObservation& landmark : constraints.landmarks)
        add_landmark(landmark, out.T_camera_world, equations);
      if (i == limits.iterations) break;
      Matrix6 damped = equations.hessian;
      damped.diagonal() += Vector6::Constant(1.0) + 1e-6 * equations.hessian.diagonal();
      const Vector6 step = damped.ldlt().solve(-equations.gradient);
      if (!step.allFinite() || step.norm() > 0.5) break;
      out.T_camera_world = retract_about_body(out.T_camera_world, step);
      if (step.head<3>().norm() < limits.min_step_m && step.tail<3>().norm() < 2.0 * limits.min_step_m) break;
    }
  }
  const auto all = static_cast<double>(points[static_cast<std::size_t>(limits.finest)].size());
  out.information = equations.hessian;
  out.pairs = equations.pairs;
  out.inlier_fraction = equations.visible > 0 ? static_cast<double>(equations.pairs) / equations.visible : 0.0;
  out.visible_point_fraction = all > 0.0 ? equations.visible / all : 0.0;
  out.geometric_rms_m = equations.pairs > 0 ? std::sqrt(equations.depth_sq / equations.pairs) : 0.0;
  out.photometric_rms =
      equations.photometric_pairs > 0 ? std::sqrt(equations.photometric_sq / equations.photometric_pairs) : 0.0;
  return out;
}

Alignment compare_frame(const LevelPoints& points, const FrameLevels& frame, const Eigen::Isometry3d& T_camera_world,
                        int level) {
  AlignmentLimits limits;
  limits.iterations = 0;
  limits.coarsest = level;
  limits.finest = level;
  return align_frame(points, frame, T_camera_world, {}, limits);
}

}  // namespace houghstream::reconstruction
