#include "pose/seen/colour_score.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace houghstream {
namespace {

// Range of the gain by which exposure and haze change the model's contrast.
constexpr double kMinGain = 0.4;
constexpr double kMaxGain = 2.5;

/// Returns the colour about grey.
template <typename Lab>
Eigen::Array4f about_grey(const Lab& lab) {
  constexpr float kGrey = 128.0F;
  return {static_cast<float>(lab[0]) - kGrey, static_cast<float>(lab[1]) - kGrey, static_cast<float>(lab[2]) - kGrey,
          1.0F};
}

double variance(const ColourProducts& products, Eigen::Index channel) {
  return products(channel, channel) - products(channel, kOne) * products(channel, kOne);
}

/// Returns the mean square of a channel's observed values that is left by least squares on the model's.
double residual_chroma_variance(const ColourProducts& products, Eigen::Index model_channel,
                                Eigen::Index observed_channel) {
  const double model_variance = variance(products, model_channel);
  const double covariance =
      products(model_channel, observed_channel) - products(model_channel, kOne) * products(observed_channel, kOne);
  const double gain = std::clamp(covariance / std::max(model_variance, 1e-3), kMinGain, kMaxGain);
  return std::max(0.0, variance(products, observed_channel) - gain * (2.0 * covariance - gain * model_variance));
}

/// Returns the residual variance of the lightness after regression on the model's and on the surface's normal.
double residual_lightness_variance(const ColourProducts& products) {
  constexpr double kRidge = 1e-4;   // terms that do not vary are left alone
  constexpr int kTerms = kOne + 1;  // model value, normal (3), 1
  constexpr int kFreeTerms = kTerms - 1;
  using Terms = Eigen::Matrix<double, kTerms, 1>;
  Eigen::Matrix<double, kTerms, kTerms> normal_matrix = products.topLeftCorner<kTerms, kTerms>();
  normal_matrix.diagonal().array() += kRidge;
  const Terms moments = products.block<kTerms, 1>(0, kObservedLightness);
  Terms weights = normal_matrix.ldlt().solve(moments);
  const double gain = std::clamp(weights[0], kMinGain, kMaxGain);
  if (gain != weights[0]) {
    const Eigen::Matrix<double, kFreeTerms, 1> rest =
        moments.tail<kFreeTerms>() - gain * normal_matrix.block<kFreeTerms, 1>(1, 0);
    weights << gain, normal_matrix.bottomRightCorner<kFreeTerms, kFreeTerms>().ldlt().solve(rest);
  }
  const double observed_sq = products(kObservedLightness, kObservedLightness);
  return std::max(0.0, observed_sq - 2.0 * weights.dot(moments) + weights.dot(normal_matrix * weights));
}

ChromaMeans chroma_means(const ColourProducts& products) {
  constexpr double kOffset = 128.0;        // grey of 8-bit a* and b*
  constexpr double kUnit = 100.0 / 255.0;  // step of 8-bit lightness
  ChromaMeans means;
  means.model = {products(kA, kOne), products(kB, kOne)};
  means.measured = {products(kObservedA, kOne), products(kObservedB, kOne)};
  means.lightness = kUnit * (products(kObservedLightness, kOne) + kOffset);
  means.variance = {variance(products, kObservedA), variance(products, kObservedB)};
  return means;
}

/// The compared points, and those where the camera was at its limit.
struct SummedColours {
  ColourSums compared;
  ColourSums clipped;

  /// Returns the means of both sums. `compared_means` are those of the former, which mostly are all.
  ColourProducts all_means(const ColourProducts& compared_means) const {
    if (clipped.count() == 0) return compared_means;
    ColourSums all = compared;
    return (all += clipped).means();
  }
};

ColourComparison compare(const SummedColours& sums) {
  static const ChromaMap kAsTaught;
  const auto weighted = [](double lightness, double a, double b) {
    constexpr double kLightnessWeight = 0.5;  // shading is only roughly accounted for
    return kLightnessWeight * lightness + a + b;
  };
  const ColourProducts products = sums.compared.means();
  const double observed_variance =
      weighted(variance(products, kObservedLightness), variance(products, kObservedA), variance(products, kObservedB));
  const double model_variance =
      weighted(variance(products, kLightness), variance(products, kA), variance(products, kB));
  const double residual_variance =
      weighted(residual_lightness_variance(products), residual_chroma_variance(products, kA, kObservedA),
               residual_chroma_variance(products, kB, kObservedB));
  ColourComparison comparison;
  comparison.points = sums.compared.count();
  comparison.agreement = static_cast<float>(1.0 - residual_variance / (kUntexturedVariance + observed_variance));
  comparison.residual_stddev = static_cast<float>(std::sqrt(residual_variance));
  comparison.chroma = chroma_means(sums.all_means(products));
  comparison.unclipped_chroma = chroma_means(products);
  comparison.chroma_difference = chroma_difference(comparison.chroma, kAsTaught);
  comparison.clipped = sums.clipped.count();
  comparison.observed_contrast = static_cast<float>(std::sqrt(std::max(0.0, observed_variance)));
  comparison.model_contrast = static_cast<float>(std::sqrt(std::max(0.0, model_variance)));
  return comparison;
}

}  // namespace

float chroma_difference(const ChromaMeans& means, const ChromaMap& camera) {
  constexpr double kPlain = 100.0;  // variance that plain surfaces have in changing light
  constexpr double kPalest = 0.5;   // strengths over the expected one
  constexpr double kStrongest = 2.5;
  constexpr double kMax = 4.0;
  const Eigen::Vector2d expected = camera.apply(means.model, means.lightness);
  const double strength =
      std::clamp(expected.dot(means.measured) / std::max(expected.squaredNorm(), 1.0), kPalest, kStrongest);
  const double spread_sq = kPlain + means.variance.x() + means.variance.y();
  return static_cast<float>(std::min(kMax, (means.measured - strength * expected).norm() / std::sqrt(spread_sq)));
}

std::optional<ColourComparison> compare_colours(const LabRegion& colours, const ProjectedView& projected,
                                                const DepthTolerance& tolerance) {
  constexpr int kMin = 30;
  constexpr float kNormalUnits = 100.0F;  // brings normals to the size of the other terms
  if (projected.view.colours.empty()) return std::nullopt;
  const auto width = static_cast<float>(tolerance.at(projected.depth));
  const cv::Rect part(cv::Point(), colours.lab.size());
  SummedColours sums;
  std::array<ComparedPoint, 64> points;
  std::size_t count = 0;
  for (std::size_t i = 0; i < projected.points.size(); ++i) {
    const ProjectedPoint& point = projected.points[i];
    const cv::Point inside = cv::Point(point.x, point.y) - colours.origin_px;
    if (!(std::abs(point.depth_difference) <= width) || !part.contains(inside)) continue;
    const Eigen::Vector3f normal = kNormalUnits * (projected.T.linear() * projected.view.normals[i]);
    points[count] = {about_grey(projected.view.colours[i]),
                     about_grey(colours.lab.at<cv::Vec3b>(inside)),
                     {normal.x(), normal.y(), normal.z(), 1.0F}};
    if (!colours.clipped.empty() && colours.clipped.at<std::uint8_t>(inside) != 0) {
      sums.clipped.add(&points[count], 1);
      continue;
    }
    if (++count < points.size()) continue;
    sums.compared.add(points, count);
    count = 0;
  }
  sums.compared.add(points, count);
  if (sums.compared.count() < kMin) return std::nullopt;
  return compare(sums);
}

std::optional<ColourComparison> compare_texture(const ObjectObservation& observation, const ProjectedView& projected,
                                                const DepthTolerance& tolerance) {
  constexpr double kDetailsPerMean =
      2.5;                         // averaged over so many of the model's details, so that a little beside is near,
  constexpr double kMax = 5.0;     // or at most over so many pixels
  constexpr int kSmoothed_px = 3;  // pixels over which LabRegion's colours are averaged already
  const LabRegion& colours = observation.colours;
  if (colours.lab.empty() || !(projected.depth > 0.0)) return std::nullopt;
  const double detail_m = 2.0 * static_cast<double>(observation.model.radius) / ModelSettings{}.pixels_per_diameter;
  const double averaged_px =
      std::min(kDetailsPerMean * detail_m / observation.frame.camera.metres_per_px(projected.depth), kMax);
  const int side = 2 * static_cast<int>(0.5 * averaged_px) + 1;
  const int reach = side > kSmoothed_px ? 2 : 1;
  LabRegion shifted{{}, {}, colours.clipped};  // a copy of the image would be the image, and change with it
  if (side > kSmoothed_px) {
    cv::blur(colours.lab, shifted.lab, cv::Size(side, side));
  } else {
    shifted.lab = colours.lab;
  }
  std::optional<ColourComparison> best;
  for (const int dy : {0, -reach, reach}) {
    for (const int dx : {0, -reach, reach}) {
      shifted.origin_px = colours.origin_px + cv::Point(dx, dy);
      const std::optional<ColourComparison> comparison = compare_colours(shifted, projected, tolerance);
      if (comparison && (!best || comparison->agreement > best->agreement)) best = comparison;
    }
  }
  return best;
}

float joint_score(float depth_value, const std::optional<ColourComparison>& colour) {
  constexpr float kUnknown = 0.5F;
  const float kept = 0.1F + 0.9F * std::clamp(colour ? colour->agreement : kUnknown, 0.0F, 1.0F);
  return depth_value > 0.0F ? kept * std::sqrt(depth_value) : depth_value;
}

}  // namespace houghstream
