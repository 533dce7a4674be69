#include "pose/following/joint_registration.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace houghstream {
namespace {

constexpr int kUpdates = 2;              // steps with the same lines
constexpr int kMinPairs = 12;            // pairs of depth; fewer agree by chance
constexpr float kMinForeground = 0.02F;  // chosen: where the light changes, depth is what is left to follow by

/// One level of the coarse-to-fine registration.
struct JointLevel {
  double points = 1.0;  // fraction of JointSettings::points
  int search_steps = 2;
  RegionScale scale;
  EdgeStep step = EdgeStep::kAlongGradient;
  std::size_t texture = 0;  // index into BrightnessImage::levels
};

/// Scales and deviations are those of M3T's defaults (Stoiber et al. 2023), but for the finest deviation, there 1.5:
/// neighbouring lines err alike.
constexpr std::array<JointLevel, 4> kLevels = {{{0.25, 2, {6, 15.0, 3}, EdgeStep::kToMean, 1},
                                                {0.4, 2, {4, 5.0, 2}, EdgeStep::kAlongGradient, 1},
                                                {0.7, 1, {2, 3.5, 1}, EdgeStep::kAlongGradient, 0},
                                                {1.0, 1, {1, 2.0, 1}, EdgeStep::kAlongGradient, 0}}};

/// Returns the probability that the pixel of a measured point shows the object, by its colour: a hand that grips an
/// object lies within the distance of pairs, and would pull the pose towards itself. Nothing without colours.
PairWeight foreground_weight(const RgbdFrame& frame, const ColourStatistics* colours) {
  if (colours == nullptr || colours->empty()) return nullptr;
  return [&frame, colours](const Eigen::Vector3f& measured) {
    const Eigen::Vector2d pixel = frame.camera.project(measured.cast<double>());
    const cv::Point at_px(cvRound(pixel.x()), cvRound(pixel.y()));
    return std::max(kMinForeground, colours->foreground(frame.colour.at<cv::Vec3b>(at_px)));
  };
}

/// State of one registration from its first level to its last.
class JointRegistration {
 public:
  JointRegistration(const ObjectObservation& observation, const JointStart& start, const JointSettings& settings,
                    const RegistrationSettings& registration)
      : observation_(observation),
        view_{observation.frame, observation.model, observation.noise},
        start_(start),
        settings_(settings),
        registration_(registration),
        end_m_(correspondence_distances(observation, registration).end),
        sigma_m_(settings.depth_sigmas * observation.noise.sigma(observation.centre_camera.z())),
        weight_(foreground_weight(observation.frame, start.appearance.colours.get())) {
    result_.silhouette = start.appearance.silhouette;
    result_.registration.T_camera_object = start.T_camera_object;
    if (is_textured()) brightness_ = make_brightness(observation.frame, observation.region.box_px);
  }

  JointResult run() {
    const double start_m = std::max(settings_.start_m, end_m_);
    const double shrink = std::pow(end_m_ / start_m, 1.0 / static_cast<double>(kLevels.size() - 1));
    double distance_m = start_m;
    for (std::size_t i = 0; i < kLevels.size(); ++i) {
      if (2 * i == kLevels.size() && start_.refine_by_texture) {
        pose() = start_.refine_by_texture(pose());
        brightness_ = {};
      }
      is_finest_ = i + 1 == kLevels.size();
      register_level(kLevels[i], distance_m);
      distance_m = std::max(end_m_, distance_m * shrink);
    }
    measure_inliers();
    return std::move(result_);
  }

 private:
  Eigen::Isometry3d& pose() { return result_.registration.T_camera_object; }

  bool is_textured() const { return start_.appearance.texture && start_.appearance.texture->is_textured(); }

  void register_level(const JointLevel& level, double distance_m) {
    const RegionLines lines = find_lines(level);
    result_.edges = static_cast<int>(lines.lines.size());
    result_.blank = lines.blank;
    result_.covered = lines.covered;
    for (int i = 0; i < kUpdates; ++i) {
      MotionEquations all = region_equations(view_, lines.lines, pose(), level.scale, level.step, settings_.region);
      if (is_textured())
        add(texture_equations(view_, brightness_, *start_.appearance.texture, pose(), level.texture, settings_.texture),
            1.0, all);
      if (is_finest_) result_.information = all.hessian;
      const bool has_depth = add_depth(level, distance_m, all);
      if (!has_depth && lines.lines.empty()) return;
      apply_step(all);
    }
  }

  /// Returns the motion of one deviation of the lag, as MotionEquations have it.
  Vector6d lag_motion() {
    const Eigen::Vector3d arm = pose().linear() * observation_.model.centre.cast<double>();
    Vector6d motion;
    motion << observation_.model.radius * start_.depth_lag.rotation_rad,
        start_.depth_lag.shift_m + start_.depth_lag.rotation_rad.cross(arm);
    return motion;
  }

  /// Returns the object's pose at the time of the depth measurement, by the estimated lag.
  Eigen::Isometry3d depth_pose() {
    Eigen::Isometry3d T = pose();
    move_by_step(lag_.deviations * lag_motion(), observation_.model, T);
    return T;
  }

  /// Marginalises the lag out of depth's equations (Schur complement; its prior is one deviation).
  void marginalise_lag(MotionEquations& equations) {
    const Vector6d motion = lag_motion();
    lag_.cross_terms = equations.hessian.selfadjointView<Eigen::Lower>() * motion;
    lag_.hessian = 1.0 + motion.dot(lag_.cross_terms);
    lag_.gradient = motion.dot(equations.gradient) - lag_.deviations;
    equations.gradient -= lag_.cross_terms * (lag_.gradient / lag_.hessian);
    add_outer_product(lag_.cross_terms, -1.0 / lag_.hessian, equations.hessian);
  }

  static void add(const MotionEquations& part, double weight, MotionEquations& all) {
    all.hessian += weight * part.hessian;
    all.gradient += weight * part.gradient;
  }

  /// Adds the equations of depth. Returns false where there is too little depth.
  bool add_depth(const JointLevel& level, double distance_m, MotionEquations& all) {
    const auto points = static_cast<std::size_t>(std::lround(level.points * settings_.points));
    const CorrespondenceSums pairs = sum_correspondences(observation_, depth_pose(), points,
                                                         {static_cast<float>(distance_m), level.search_steps}, weight_);
    if (pairs.count < kMinPairs) return false;
    // A level with fewer pairs weighs as much as the finest one.
    const double weight = 1.0 / (level.points * sigma_m_ * sigma_m_);
    lag_.hessian = 0.0;
    const bool has_colour_equations = !all.hessian.isZero(0.0);
    const auto build = [&](double point_weight) {
      MotionEquations depth;
      add(build_equations(pairs, point_weight), weight, depth);
      if (has_colour_equations) marginalise_lag(depth);
      return depth;
    };
    if (is_finest_) result_.information += build(0.0).hessian;
    add(build(registration_.point_weight), 1.0, all);
    return true;
  }

  RegionLines find_lines(const JointLevel& level) {
    const std::shared_ptr<const ColourStatistics>& colours = start_.appearance.colours;
    if (!colours || settings_.region.lines == 0) return {};
    if (!result_.silhouette || !is_silhouette_of(*result_.silhouette, observation_.model, pose()))
      result_.silhouette =
          std::make_shared<const Silhouette>(make_silhouette(observation_.model, pose(), settings_.region.lines));
    return find_region_lines(view_, *result_.silhouette, *colours, pose(), level.scale, settings_.region);
  }

  void apply_step(MotionEquations& all) {
    const double rotation_m = settings_.tikhonov_rad * observation_.model.radius;
    all.hessian.diagonal().head<3>().array() += 1.0 / (rotation_m * rotation_m);
    all.hessian.diagonal().tail<3>().array() += 1.0 / (settings_.tikhonov_m * settings_.tikhonov_m);
    const Eigen::LDLT<Matrix6d> solver = all.hessian.selfadjointView<Eigen::Lower>().ldlt();
    const Vector6d step = solver.solve(all.gradient);
    if (lag_.hessian > 0.0) {
      lag_.deviations += (lag_.gradient - lag_.cross_terms.dot(step)) / lag_.hessian;
      if (is_finest_) measure_lag(solver);
    }
    ++result_.registration.iterations;
    result_.registration.converged =
        step.allFinite() && move_by_step(step, observation_.model, pose()) < registration_.converged_m;
  }

  /// Notes what is known of the lag when the pose is free as well, less its prior.
  void measure_lag(const Eigen::LDLT<Matrix6d>& solver) {
    const double from_pose = lag_.cross_terms.dot(solver.solve(lag_.cross_terms)) / (lag_.hessian * lag_.hessian);
    const double variance = 1.0 / lag_.hessian + from_pose;
    result_.lag.information = std::max(0.0, 1.0 / variance - 1.0);
    result_.lag.weighted = lag_.deviations / variance;
  }

  void measure_inliers() {
    RegistrationResult& out = result_.registration;
    const auto points = static_cast<std::size_t>(settings_.points);
    const CorrespondenceSums last =
        sum_correspondences(observation_, depth_pose(), points, {static_cast<float>(end_m_), 1});
    const std::size_t used = std::min(points, nearest_view(observation_.model, pose()).points.size());
    out.inliers = last.count;
    out.inlier_fraction = static_cast<float>(last.count) / static_cast<float>(used);
    out.residual = static_cast<float>(std::sqrt(last.squares / last.count));  // 0/0 is NaN
  }

  /// Displacement of the object at the time of the depth measurement, in deviations of the lag, with its normal
  /// equation.
  struct Lag {
    double deviations = 0.0;
    Vector6d cross_terms = Vector6d::Zero();  // products with the motion
    double hessian = 0.0;
    double gradient = 0.0;
  };

  const ObjectObservation& observation_;
  const RegionView view_;
  const JointStart& start_;
  const JointSettings& settings_;
  const RegistrationSettings& registration_;
  const double end_m_;
  const double sigma_m_;  // standard deviation of a pair of depth
  const PairWeight weight_;
  bool is_finest_ = false;  // whether the level is the last one, of whose updates the last is the result's evidence
  BrightnessImage brightness_;
  Lag lag_;
  JointResult result_;
};

}  // namespace

JointResult register_jointly(const ObjectObservation& observation, const JointStart& start,
                             const JointSettings& settings, const RegistrationSettings& registration) {
  return JointRegistration(observation, start, settings, registration).run();
}

Eigen::Matrix3d observed_rotation(const Matrix6d& information, double radius, const JointSettings& settings) {
  const Matrix6d full = information.selfadjointView<Eigen::Lower>();
  // A shift may compensate a rotation: this is the information on the rotation that is left when the shift is free as
  // well.
  constexpr double kMinInformation = 1.0;  // 1/m^2
  const Eigen::Matrix3d shift = full.bottomRightCorner<3, 3>() + kMinInformation * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d cross_terms = full.topRightCorner<3, 3>();
  const Eigen::Matrix3d rotation =
      full.topLeftCorner<3, 3>() - cross_terms * shift.ldlt().solve(cross_terms.transpose());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(rotation);
  const double prior = 1.0 / std::pow(settings.tikhonov_rad * radius, 2.0);
  const Eigen::Vector3d eigenvalues = solver.eigenvalues().cwiseMax(0.0);
  const Eigen::Vector3d gains = eigenvalues.array() / (eigenvalues.array() + prior);
  return solver.eigenvectors() * gains.asDiagonal() * solver.eigenvectors().transpose();
}

}  // namespace houghstream
