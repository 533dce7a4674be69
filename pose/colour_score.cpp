#include "pose/colour_score.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace houghstream {
namespace {

// What exposure and haze make of a remembered contrast.
constexpr double kLeastGain = 0.4;
constexpr double kMostGain = 2.5;

/// Least squares of a channel's seen values on the remembered ones.
struct ChromaFit {
  double remembered = 0.0;
  double seen = 0.0;
  double remembered_sq = 0.0;
  double seen_sq = 0.0;
  double product = 0.0;

  void add(double a, double b) {
    remembered += a;
    seen += b;
    remembered_sq += a * a;
    seen_sq += b * b;
    product += a * b;
  }

  double seen_variance(double count) const { return seen_sq / count - seen * seen / (count * count); }

  /// Mean square that is left over.
  double left_over(double count) const {
    const double variance = remembered_sq / count - remembered * remembered / (count * count);
    const double covariance = product / count - remembered * seen / (count * count);
    const double gain = std::clamp(covariance / std::max(variance, 1e-3), kLeastGain, kMostGain);
    return std::max(0.0, seen_variance(count) - gain * (2.0 * covariance - gain * variance));
  }
};

/// The same for lightness on the remembered one and the surface's normal.
struct LightnessFit {
  static constexpr int kTerms = 5;  // remembered value, normal (3), 1
  using Terms = Eigen::Matrix<double, kTerms, 1>;
  Eigen::Matrix<double, kTerms, kTerms> products = Eigen::Matrix<double, kTerms, kTerms>::Zero();
  Terms with_seen = Terms::Zero();
  double seen_sq = 0.0;

  void add(const Terms& terms, double seen) {
    products.noalias() += terms * terms.transpose();
    with_seen += seen * terms;
    seen_sq += seen * seen;
  }

  double seen_variance(double count) const {
    const double mean = with_seen[kTerms - 1] / count;
    return seen_sq / count - mean * mean;
  }

  double left_over(double count) const {
    constexpr double kDamping = 1e-4;  // of the count: terms that do not vary are left alone
    Eigen::Matrix<double, kTerms, kTerms> curvature = products;
    curvature.diagonal().array() += kDamping * count;
    Terms weights = curvature.ldlt().solve(with_seen);
    const double gain = std::clamp(weights[0], kLeastGain, kMostGain);
    if (gain != weights[0]) {
      constexpr int kOthers = kTerms - 1;
      const Eigen::Matrix<double, kOthers, 1> rest =
          with_seen.tail<kOthers>() - gain * curvature.block<kOthers, 1>(1, 0);
      weights << gain, curvature.bottomRightCorner<kOthers, kOthers>().ldlt().solve(rest);
    }
    const double square = seen_sq - 2.0 * weights.dot(with_seen) + weights.dot(curvature * weights);
    return std::max(0.0, square / count);
  }
};

/// Pairs of what the model has and what is seen.
struct ColourFit {
  LightnessFit lightness;
  ChromaFit a;
  ChromaFit b;
  int count = 0;

  void add(const LabColour& remembered, const Eigen::Vector3d& normal, const cv::Vec3b& seen) {
    constexpr double kNormalUnits = 100.0;  // brings normals to the size of the other terms
    LightnessFit::Terms terms;
    terms << remembered[0], kNormalUnits * normal, 1.0;
    lightness.add(terms, seen[0]);
    a.add(remembered[1], seen[1]);
    b.add(remembered[2], seen[2]);
    ++count;
  }

  float agreement() const {
    constexpr double kNoise = 15.0;     // variance of the three channels on a plain surface in even light
    constexpr double kLightness = 0.5;  // shading is only roughly accounted for
    const double n = count;
    const double seen = kNoise + kLightness * lightness.seen_variance(n) + a.seen_variance(n) + b.seen_variance(n);
    const double left = kLightness * lightness.left_over(n) + a.left_over(n) + b.left_over(n);
    return static_cast<float>(1.0 - left / seen);
  }
};

}  // namespace

LabRegion lab_region(const RgbdFrame& frame, const cv::Rect& part_px) {
  LabRegion region{{}, part_px.tl()};
  cv::blur(frame.colour(part_px), region.lab, cv::Size(3, 3));
  cv::cvtColor(region.lab, region.lab, cv::COLOR_BGR2Lab);
  return region;
}

std::optional<float> colour_agreement(const RgbdFrame& frame, const LabRegion& colours, const ObjectModel& model,
                                      const Eigen::Isometry3d& T_camera_object, int points,
                                      const DepthTolerance& tolerance) {
  constexpr int kFewest = 30;
  const ModelView& view = nearest_view(model, T_camera_object);
  if (view.colours.empty()) return std::nullopt;
  const auto width = static_cast<float>(tolerance.at(T_camera_object.translation().z()));
  ColourFit fit;
  for (std::size_t i = 0; i < std::min<std::size_t>(static_cast<std::size_t>(points), view.points.size()); ++i) {
    const Eigen::Vector3d point = T_camera_object * view.points[i].cast<double>();
    if (!(point.z() > 0.0)) continue;
    const Eigen::Vector2d pixel = frame.camera.project(point) + Eigen::Vector2d::Constant(0.5);
    const cv::Point at(static_cast<int>(std::floor(pixel.x())), static_cast<int>(std::floor(pixel.y())));
    const cv::Point inside = at - colours.origin_px;
    if (!cv::Rect(cv::Point(), colours.lab.size()).contains(inside)) continue;
    if (!(std::abs(frame.depth.at<float>(at) - static_cast<float>(point.z())) <= width)) continue;
    fit.add(view.colours[i], T_camera_object.linear() * view.normals[i].cast<double>(),
            colours.lab.at<cv::Vec3b>(inside));
  }
  if (fit.count < kFewest) return std::nullopt;
  return fit.agreement();
}

float joint_score(float depth_value, std::optional<float> colour) {
  constexpr float kUnknown = 0.5F;
  const float kept = 0.1F + 0.9F * std::clamp(colour.value_or(kUnknown), 0.0F, 1.0F);
  return depth_value > 0.0F ? kept * depth_value : depth_value;
}

}  // namespace houghstream
