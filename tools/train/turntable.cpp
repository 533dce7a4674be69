#include "tools/train/turntable.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/core/optim.hpp>

#include "pipeline/base/checks.hpp"

namespace houghstream {
namespace {

using Vector6f = Eigen::Matrix<float, 6, 1>;
using Features = std::vector<Vector6f>;  // position in metres, colour as metres

/// Few points of few views tell the axis: the search compares all of them again and again.
struct Sample {
  double yaw = 0.0;
  std::vector<ColouredPoint> points;
};

std::vector<Sample> take_sample(const std::vector<TurntableView>& views) {
  constexpr std::size_t kViews = 20;
  constexpr std::size_t kPoints = 150;
  std::vector<const TurntableView*> seen;
  for (const TurntableView& view : views) {
    if (!view.points.empty()) seen.push_back(&view);
  }
  require(!seen.empty(), "{} turntable views without any depth on the object, expected some", views.size());
  std::stable_sort(seen.begin(), seen.end(), [](const auto* a, const auto* b) { return a->yaw < b->yaw; });
  std::vector<Sample> samples;
  const std::size_t count = std::min(kViews, seen.size());
  for (std::size_t i = 0; i < count; ++i) {
    const TurntableView& view = *seen[i * seen.size() / count];
    Sample sample{view.yaw, {}};
    const std::size_t points = std::min(kPoints, view.points.size());
    for (std::size_t k = 0; k < points; ++k) sample.points.push_back(view.points[k * view.points.size() / points]);
    samples.push_back(std::move(sample));
  }
  return samples;
}

/// Returns the camera axes of an upright object frame seen from `elevation` above the horizon (radians).
Eigen::Matrix3d upright_rotation(double elevation) {
  const double s = std::sin(elevation);
  const double c = std::cos(elevation);
  Eigen::Matrix3d R_camera_axis;
  R_camera_axis << 1.0, 0.0, 0.0,  //
      0.0, -s, -c,                 //
      0.0, c, -s;
  return R_camera_axis;
}

Features object_features(const Sample& sample, const Turntable& table) {
  // A full change of one colour channel counts as much as 2 cm.
  constexpr float kMetresPerLevel = 0.02F / 255.0F;
  const Eigen::Isometry3d T_object_camera = table.pose_at(sample.yaw).inverse();
  Features features;
  for (const ColouredPoint& point : sample.points) {
    Vector6f feature;
    feature.head<3>() = (T_object_camera * point.position).cast<float>();
    for (int c = 0; c < 3; ++c) feature[3 + c] = kMetresPerLevel * static_cast<float>(point.colour[c]);
    features.push_back(feature);
  }
  return features;
}

/// Sums the squared distances from each point of `from` to the nearest of `to`, of the nearer 70 % only: the rest of
/// one view's surface is hidden in the other.
double trimmed_distance_sq(const Features& from, const Features& to) {
  std::vector<float> nearest_sq;
  nearest_sq.reserve(from.size());
  for (const Vector6f& point : from) {
    float best = std::numeric_limits<float>::infinity();
    for (const Vector6f& other : to) best = std::min(best, (other - point).squaredNorm());
    nearest_sq.push_back(best);
  }
  const auto kept = static_cast<std::ptrdiff_t>(std::max<std::size_t>(1, nearest_sq.size() * 7 / 10));
  std::nth_element(nearest_sq.begin(), nearest_sq.begin() + kept - 1, nearest_sq.end());
  double sum = 0.0;
  for (std::ptrdiff_t i = 0; i < kept; ++i) sum += static_cast<double>(nearest_sq[i]);
  return sum / static_cast<double>(kept);
}

/// Returns the mean squared residual of each view, rotated back, against the next two.
double mean_residual_sq(const std::vector<Sample>& samples, const Turntable& table) {
  std::vector<Features> features;
  features.reserve(samples.size());
  for (const Sample& sample : samples) features.push_back(object_features(sample, table));
  double sum = 0.0;
  for (std::size_t i = 0; i < features.size(); ++i) {
    for (std::size_t step = 1; step <= 2; ++step) {
      sum += trimmed_distance_sq(features[i], features[(i + step) % features.size()]);
    }
  }
  return sum / static_cast<double>(2 * features.size());
}

/// Returns the middle of the visible surface, half a width behind its near side.
Eigen::Vector3d rough_centre(const std::vector<Sample>& samples) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Sample& sample : samples) {
    Eigen::Vector3d low = sample.points.front().position;
    Eigen::Vector3d high = low;
    for (const ColouredPoint& point : sample.points) {
      low = low.cwiseMin(point.position);
      high = high.cwiseMax(point.position);
    }
    sum += 0.5 * (low + high) + Eigen::Vector3d(0.0, 0.0, 0.25 * (high.x() - low.x()));
  }
  return sum / static_cast<double>(samples.size());
}

/// Returns the axis shifted by x[0], x[1] metres across itself, from an elevation of x[2] radians.
Turntable table_from(const double* x, const Eigen::Vector3d& centre, double direction) {
  Turntable table;
  table.direction = direction;
  table.T_camera_axis.linear() = upright_rotation(x[2]);
  table.T_camera_axis.translation() = centre + table.T_camera_axis.linear() * Eigen::Vector3d(x[0], x[1], 0.0);
  return table;
}

class TurntableResidual : public cv::MinProblemSolver::Function {
 public:
  TurntableResidual(const std::vector<Sample>& samples, const Eigen::Vector3d& centre, double direction)
      : samples_(samples), centre_(centre), direction_(direction) {}
  int getDims() const override { return 3; }
  double calc(const double* x) const override {
    // Turned upside down, the object would fit as well with the other direction.
    constexpr double kMin = -0.4;
    constexpr double kMaxHeight = 1.6;
    constexpr double kNever = 1e6;
    if (x[2] < kMin || x[2] > kMaxHeight) return kNever;
    return mean_residual_sq(samples_, table_from(x, centre_, direction_));
  }

 private:
  const std::vector<Sample>& samples_;
  Eigen::Vector3d centre_;
  double direction_;
};

/// Fits the table by the downhill simplex (Nelder & Mead 1965) from a usual elevation.
std::pair<double, Turntable> fit_table(const std::vector<Sample>& samples, double direction) {
  const Eigen::Vector3d centre = rough_centre(samples);
  constexpr double kFirstElevation = 0.5;
  cv::Mat x = (cv::Mat_<double>(1, 3) << 0.0, 0.0, kFirstElevation);
  const cv::Mat step = (cv::Mat_<double>(1, 3) << 0.02, 0.02, 0.3);
  const auto solver =
      cv::DownhillSolver::create(cv::makePtr<TurntableResidual>(samples, centre, direction), step,
                                 cv::TermCriteria(cv::TermCriteria::MAX_ITER + cv::TermCriteria::EPS, 200, 1e-10));
  const double residual_sq = solver->minimize(x);
  return {residual_sq, table_from(x.ptr<double>(), centre, direction)};
}

/// Moves the origin along the axis to half the object's height; single stray points do not count.
void centre_height(const std::vector<Sample>& samples, Turntable& table) {
  std::vector<double> heights;
  for (const Sample& sample : samples) {
    const Eigen::Isometry3d T_object_camera = table.pose_at(sample.yaw).inverse();
    for (const ColouredPoint& point : sample.points) heights.push_back((T_object_camera * point.position).z());
  }
  std::sort(heights.begin(), heights.end());
  const std::size_t stray = heights.size() / 100;
  const double middle = 0.5 * (heights[stray] + heights[heights.size() - 1 - stray]);
  table.T_camera_axis.translation() += table.T_camera_axis.linear() * Eigen::Vector3d(0.0, 0.0, middle);
}

}  // namespace

Eigen::Isometry3d Turntable::pose_at(double yaw) const {
  return T_camera_axis * Eigen::AngleAxisd(direction * yaw, Eigen::Vector3d::UnitZ());
}

Turntable estimate_turntable(const std::vector<TurntableView>& views) {
  const std::vector<Sample> samples = take_sample(views);
  const auto counter_clockwise = fit_table(samples, 1.0);
  const auto clockwise = fit_table(samples, -1.0);
  Turntable table = clockwise.first < counter_clockwise.first ? clockwise.second : counter_clockwise.second;
  centre_height(samples, table);
  return table;
}

}  // namespace houghstream
