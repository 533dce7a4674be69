#include "pipeline/types/chroma_map.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>

#include "pipeline/base/logit.hpp"

namespace houghstream {
namespace {

using Parameters = ChromaMap::Parameters;
using Covariance = ChromaMap::Covariance;
using Regressors = Eigen::Matrix<double, 2, ChromaMap::kParameters>;

// Variance of an object's mean chroma about its model's, per channel: texture, wear, coloured light nearby, and a view
// that differs slightly from the observed one. Correct poses of YCB-V's scenes 0, 1 and 50 lie 9 to 12 from the best
// map of their scene, both channels together.
constexpr double kObjectVariance = 80.0;
constexpr double kOutlierVariance = 600.0;  // variance of the chroma of anything else, about grey
constexpr double kMargin = 0.02;            // no evidence is certain

Regressors regressors(const Eigen::Vector2d& model, double lightness) {
  const double cast = chroma_scale(lightness);
  Regressors out;
  out << model.x(), model.y(), 0.0, 0.0, cast, 0.0,  //
      0.0, 0.0, model.x(), model.y(), 0.0, cast;
  return out;
}

Parameters identity() {
  Parameters out;
  out << 1.0, 0.0, 0.0, 1.0, 0.0, 0.0;
  return out;
}

/// Returns the covariance of cameras about the one used for teaching: second moments about the identity over simulated
/// cameras, whose light has a mean of 5500 K and a standard deviation of 45 mired, with saturation and gamma off by a
/// fifth. Saturation changes both gains alike, and a warm light turns red towards yellow where it makes white yellow.
const Covariance& prior_covariance() {
  static const Covariance kPrior = [] {
    Parameters sigma;
    sigma << 0.195, 0.102, 0.066, 0.210, 3.56, 11.9;
    Covariance correlation;
    correlation << 1.00, 0.08, 0.44, 0.87, -0.03, 0.04,  //
        0.08, 1.00, 0.32, -0.35, -0.32, 0.87,            //
        0.44, 0.32, 1.00, 0.15, 0.12, 0.50,              //
        0.87, -0.35, 0.15, 1.00, 0.10, -0.42,            //
        -0.03, -0.32, 0.12, 0.10, 1.00, -0.35,           //
        0.04, 0.87, 0.50, -0.42, -0.35, 1.00;
    return Covariance(sigma.asDiagonal() * correlation * sigma.asDiagonal());
  }();
  return kPrior;
}

/// Returns false for NaN.
bool is_chroma(const Eigen::Vector2d& ab) {
  constexpr double kMax = 130.0;  // range of sRGB's colours
  return std::abs(ab.x()) <= kMax && std::abs(ab.y()) <= kMax;
}

/// Returns the logarithm of the density of a normal distribution about zero, times 2 pi.
double log_density(const Eigen::Vector2d& off, const Eigen::Matrix2d& covariance) {
  const Eigen::LLT<Eigen::Matrix2d> factor(covariance);
  const double root = factor.matrixLLT()(0, 0) * factor.matrixLLT()(1, 1);
  return -0.5 * off.dot(factor.solve(off)) - std::log(root);
}

/// Probability that the pair is of the object that it names.
double responsibility(const ChromaPair& pair, const ChromaMap& map) {
  const Eigen::Matrix2d spread =
      map.uncertainty(pair.model, pair.lightness) + kObjectVariance * Eigen::Matrix2d::Identity();
  const double own = log_density(pair.measured - map.apply(pair.model, pair.lightness), spread);
  const double other = log_density(pair.measured, kOutlierVariance * Eigen::Matrix2d::Identity());
  return logistic(logit(pair.probability, kMargin) + own - other);
}

ChromaMap weighted_fit(const std::vector<const ChromaPair*>& pairs, const std::vector<double>& weights) {
  static const Covariance kPriorPrecision = prior_covariance().llt().solve(Covariance::Identity());
  Covariance precision = kPriorPrecision;
  Parameters with_residual = Parameters::Zero();
  double objects = 0.0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Regressors x = regressors(pairs[i]->model, pairs[i]->lightness);
    const double weight = weights[i] / kObjectVariance;
    precision += weight * x.transpose() * x;
    with_residual += weight * x.transpose() * (pairs[i]->measured - x * identity());
    objects += weights[i];
  }
  const Eigen::LLT<Covariance> factor(precision);
  return {identity() + factor.solve(with_residual), factor.solve(Covariance::Identity()), objects};
}

bool has_say(const ChromaPair& pair) {
  return is_chroma_pair(pair) && pair.probability > 0.0;
}

ChromaMap fit(const std::vector<const ChromaPair*>& pairs) {
  constexpr int kRounds = 8;
  ChromaMap map;
  if (pairs.empty()) return map;
  std::vector<double> weights(pairs.size());
  for (int round = 0; round < kRounds; ++round) {
    std::transform(pairs.begin(), pairs.end(), weights.begin(),
                   [&](const ChromaPair* pair) { return responsibility(*pair, map); });
    map = weighted_fit(pairs, weights);
  }
  return map;
}

}  // namespace

ChromaMap::ChromaMap() : parameters_(identity()), covariance_(prior_covariance()) {}

ChromaMap::ChromaMap(const Parameters& parameters, const Covariance& covariance, double objects)
    : parameters_(parameters), covariance_(covariance), objects_(objects) {}

Eigen::Vector2d ChromaMap::apply(const Eigen::Vector2d& model, double lightness) const {
  return regressors(model, lightness) * parameters_;
}

Eigen::Matrix2d ChromaMap::uncertainty(const Eigen::Vector2d& model, double lightness) const {
  const Regressors x = regressors(model, lightness);
  return x * covariance_ * x.transpose();
}

double ChromaMap::saturation() const {
  return std::sqrt(std::abs(parameters_(0) * parameters_(3) - parameters_(1) * parameters_(2)));
}

Eigen::Vector2d ChromaMap::white() const {
  constexpr double kWhite = 100.0;
  return apply(Eigen::Vector2d::Zero(), kWhite);
}

std::string describe(const ChromaMap& map) {
  return fmt::format("saturation {:.2f}, white looks like a* {:+.0f} b* {:+.0f}, from {:.0f} objects, to within {:.0f}",
                     map.saturation(), map.white().x(), map.white().y(), map.objects(), map.sigma());
}

double ChromaMap::sigma() const {
  const Eigen::Vector2d medium(30.0, 30.0);
  constexpr double kLightness = 60.0;
  return std::sqrt(0.5 * uncertainty(medium, kLightness).trace());
}

bool is_chroma_pair(const ChromaPair& pair) {
  return is_chroma(pair.model) && is_chroma(pair.measured) && pair.lightness >= 0.0 && pair.lightness <= 100.0 &&
         pair.probability >= 0.0 && pair.probability <= 1.0;
}

ChromaMap fit_chroma_map(const std::vector<ChromaPair>& pairs) {
  std::vector<const ChromaPair*> used;
  for (const ChromaPair& pair : pairs) {
    if (has_say(pair)) used.push_back(&pair);
  }
  return fit(used);
}

ChromaMap fit_chroma_map_without(const std::string& class_name, const std::vector<ChromaPair>& pairs) {
  std::vector<const ChromaPair*> used;
  for (const ChromaPair& pair : pairs) {
    if (has_say(pair) && pair.class_name != class_name) used.push_back(&pair);
  }
  return fit(used);
}

std::vector<ChromaMap> fit_chroma_maps_without_each(const std::vector<ChromaPair>& pairs) {
  std::map<std::string, ChromaMap> without;
  for (const ChromaPair& left_out : pairs) {
    const std::string& name = left_out.class_name;
    if (without.count(name) == 0) without.emplace(name, fit_chroma_map_without(name, pairs));
  }
  std::vector<ChromaMap> maps;
  maps.reserve(pairs.size());
  for (const ChromaPair& pair : pairs) maps.push_back(without.at(pair.class_name));
  return maps;
}

bool is_colourless(const cv::Mat& image) {
  constexpr int kStep = 8;
  constexpr int kMaxDifference = 6;           // between channels of a grey pixel, left by JPEG
  constexpr double kMaxFraction = 0.002;      // fraction of pixels that differ by more
  if (image.type() != CV_8UC3) return false;  // is refused by whoever needs the frame
  int pixels = 0;
  int coloured = 0;
  for (int y = 0; y < image.rows; y += kStep) {
    const auto* row = image.ptr<cv::Vec3b>(y);
    for (int x = 0; x < image.cols; x += kStep) {
      const auto [minimum, maximum] = std::minmax({row[x][0], row[x][1], row[x][2]});
      ++pixels;
      coloured += maximum - minimum > kMaxDifference ? 1 : 0;
    }
  }
  return coloured <= kMaxFraction * pixels;
}

ChromaMap colourless_camera() {
  return {ChromaMap::Parameters::Zero(), ChromaMap::Covariance::Zero(), 0.0};
}

}  // namespace houghstream
