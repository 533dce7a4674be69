#include "pipeline/types/chroma_map.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>

#include "pipeline/base/log_odds.hpp"

namespace houghstream {
namespace {

using Parameters = ChromaMap::Parameters;
using Covariance = ChromaMap::Covariance;
using Regressors = Eigen::Matrix<double, 2, ChromaMap::kParameters>;

constexpr double kObjectVariance = 36.0;  // of an object's chroma about its model's: print, wear, coloured light nearby
constexpr double kOutlierVariance = 600.0;  // of the chroma of something else, about grey
constexpr double kMargin = 0.02;            // no evidence is certain

Regressors regressors(const Eigen::Vector2d& model, double lightness) {
  const double cast = (lightness + 16.0) / 116.0;
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

/// How far cameras depart from the one that taught: second moments about the identity over simulated cameras, whose
/// light has a mean of 5500 K and a standard deviation of 45 mired, with saturation and gamma off by a fifth.
/// Saturation changes both gains alike, and a warm light turns red towards yellow where it makes white yellow.
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

/// False for NaN.
bool is_chroma(const Eigen::Vector2d& ab) {
  constexpr double kMax = 130.0;  // of sRGB's colours
  return std::abs(ab.x()) <= kMax && std::abs(ab.y()) <= kMax;
}

bool has_say(const ChromaPair& pair) {
  return is_chroma(pair.model) && is_chroma(pair.measured) && pair.lightness >= 0.0 && pair.lightness <= 100.0 &&
         pair.probability > 0.0;
}

/// Logarithm of the density of a normal distribution about zero, times 2 pi.
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
  return logistic(log_odds(pair.probability, kMargin) + own - other);
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

ChromaMap fit_chroma_map(const std::vector<ChromaPair>& pairs) {
  std::vector<const ChromaPair*> used;
  for (const ChromaPair& pair : pairs) {
    if (has_say(pair)) used.push_back(&pair);
  }
  return fit(used);
}

std::vector<ChromaMap> fit_chroma_maps_without_each(const std::vector<ChromaPair>& pairs) {
  std::map<std::string, ChromaMap> without;
  for (const ChromaPair& left_out : pairs) {
    if (without.count(left_out.class_name) > 0) continue;
    std::vector<const ChromaPair*> used;
    for (const ChromaPair& pair : pairs) {
      if (has_say(pair) && pair.class_name != left_out.class_name) used.push_back(&pair);
    }
    without.emplace(left_out.class_name, fit(used));
  }
  std::vector<ChromaMap> maps;
  maps.reserve(pairs.size());
  for (const ChromaPair& pair : pairs) maps.push_back(without.at(pair.class_name));
  return maps;
}

}  // namespace houghstream
