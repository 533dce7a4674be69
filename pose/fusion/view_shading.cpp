#include "pose/fusion/view_shading.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "pipeline/base/weighted_median.hpp"

namespace houghstream::fusion {
namespace {

using Harmonics = Eigen::Matrix<double, 8, 1>;

/// Returns the harmonics without the constant one, which belongs to the albedo.
Harmonics harmonics(const Eigen::Vector3d& n) {
  Harmonics y;
  y << n.x(), n.y(), n.z(), n.x() * n.y(), n.y() * n.z(), n.x() * n.z(), n.x() * n.x() - n.y() * n.y(),
      3.0 * n.z() * n.z() - 1.0;
  return y;
}

/// A point of the surface as the fit needs it.
struct Point {
  Harmonics y;
  double level = 0.0;  ///< log brightness
  int paint = 0;       ///< points of one paint differ in light only, mostly
  double weight = 0.0;
};

constexpr int kChromas = 20;  // steps of blue's and of red's share

std::vector<Point> points_of(const std::vector<Eigen::Vector3d>& colours, const std::vector<Eigen::Vector3d>& normals) {
  constexpr double kDarkest = 0.008;  // below that noise makes the hue
  constexpr double kGrey = 0.25;      // weight of points whose albedo may be black, grey or white
  std::vector<Point> points;
  points.reserve(colours.size());
  for (std::size_t i = 0; i < colours.size(); ++i) {
    const double sum = colours[i].sum();
    if (sum < 3.0 * kDarkest) continue;
    const Eigen::Vector3d chroma = colours[i] / sum;
    Point point;
    point.y = harmonics(normals[i]);
    point.level = std::log(sum / 3.0);
    point.paint = std::min(static_cast<int>(chroma[0] * kChromas), kChromas - 1) * kChromas +
                  std::min(static_cast<int>(chroma[2] * kChromas), kChromas - 1);
    const double saturation = chroma.maxCoeff() - chroma.minCoeff();
    point.weight = kGrey + (1.0 - kGrey) * std::min(saturation / 0.3, 1.0);
    points.push_back(point);
  }
  return points;
}

/// Sums of a paint's points.
struct Albedo {
  double weight = 0.0;
  double level = 0.0;
  Harmonics y = Harmonics::Zero();
};

/// Solves one step of iteratively reweighted least squares. The means of the albedos are eliminated, and a ridge keeps
/// undetermined weights at 0.
Harmonics solve(const std::vector<Point>& points, const std::vector<double>& weights) {
  constexpr double kRidge = 0.003;
  std::vector<Albedo> paints(static_cast<std::size_t>(kChromas) * kChromas);
  double all = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    Albedo& paint = paints[static_cast<std::size_t>(points[i].paint)];
    paint.weight += weights[i];
    paint.level += weights[i] * points[i].level;
    paint.y += weights[i] * points[i].y;
    all += weights[i];
  }
  Eigen::Matrix<double, 8, 8> normal = Eigen::Matrix<double, 8, 8>::Identity() * (kRidge * all + 1e-9);
  Harmonics right = Harmonics::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Albedo& paint = paints[static_cast<std::size_t>(points[i].paint)];
    const Harmonics y = points[i].y - paint.y / paint.weight;
    normal += weights[i] * y * y.transpose();
    right += weights[i] * y * (points[i].level - paint.level / paint.weight);
  }
  return normal.ldlt().solve(right);
}

/// Returns each point's difference from the median of its albedo, after removal of the shading.
std::vector<double> departures(const std::vector<Point>& points, const Harmonics& light) {
  std::vector<double> rest(points.size());
  std::vector<std::vector<std::pair<double, double>>> of_paint(static_cast<std::size_t>(kChromas) * kChromas);
  for (std::size_t i = 0; i < points.size(); ++i) {
    rest[i] = points[i].level - light.dot(points[i].y);
    of_paint[static_cast<std::size_t>(points[i].paint)].emplace_back(rest[i], points[i].weight);
  }
  std::vector<double> middle(of_paint.size(), 0.0);
  for (std::size_t p = 0; p < of_paint.size(); ++p) middle[p] = weighted_median(of_paint[p]);
  for (std::size_t i = 0; i < points.size(); ++i) rest[i] -= middle[static_cast<std::size_t>(points[i].paint)];
  return rest;
}

std::array<double, 256> make_linear_table() {
  std::array<double, 256> table{};
  for (int i = 0; i < 256; ++i) {
    const double s = i / 255.0;
    table[static_cast<std::size_t>(i)] = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
  }
  return table;
}

}  // namespace

Eigen::Vector3d srgb_to_linear(const cv::Vec3b& colour) {
  static const std::array<double, 256> kLinear = make_linear_table();
  return {kLinear[colour[0]], kLinear[colour[1]], kLinear[colour[2]]};
}

cv::Vec3b linear_to_srgb(const Eigen::Vector3d& linear) {
  cv::Vec3b coded;
  for (int c = 0; c < 3; ++c) {
    const double l = std::clamp(linear[c], 0.0, 1.0);
    const double s = l <= 0.0031308 ? 12.92 * l : 1.055 * std::pow(l, 1.0 / 2.4) - 0.055;
    coded[c] = cv::saturate_cast<std::uint8_t>(255.0 * s);
  }
  return coded;
}

std::vector<double> estimate_exposures(const std::vector<ColourSample>& samples, int vertices, int views) {
  constexpr int kRounds = 40;
  std::vector<double> exposure(static_cast<std::size_t>(views), 0.0);
  for (int round = 0; round < kRounds; ++round) {
    std::vector<std::pair<double, double>> sent(static_cast<std::size_t>(vertices));  // level, weight
    for (const ColourSample& s : samples) {
      auto& [level, weight] = sent[static_cast<std::size_t>(s.vertex)];
      level += s.weight * (s.level - exposure[static_cast<std::size_t>(s.view)]);
      weight += s.weight;
    }
    std::vector<std::vector<std::pair<double, double>>> over(exposure.size());
    for (const ColourSample& s : samples) {
      const auto& [level, weight] = sent[static_cast<std::size_t>(s.vertex)];
      over[static_cast<std::size_t>(s.view)].emplace_back(s.level - level / weight, s.weight);
    }
    for (std::size_t v = 0; v < exposure.size(); ++v) exposure[v] = weighted_median(over[v]);
  }
  std::vector<double> sorted = exposure;
  if (!sorted.empty()) {
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2), sorted.end());
    for (double& e : exposure) e -= sorted[sorted.size() / 2];
  }
  return exposure;
}

double ShadingModel::operator()(const Eigen::Vector3d& normal) const {
  return weights_.dot(harmonics(normal));
}

ShadingModel fit_shading(const std::vector<Eigen::Vector3d>& colours, const std::vector<Eigen::Vector3d>& normals) {
  constexpr int kRounds = 20;
  constexpr double kExact = 0.05;  // departures below that are noise
  ShadingModel shade;
  const std::vector<Point> points = points_of(colours, normals);
  if (points.empty()) return shade;
  std::vector<double> weights(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) weights[i] = points[i].weight;
  for (int round = 0; round < kRounds; ++round) {
    shade.weights_ = solve(points, weights);
    const std::vector<double> rest = departures(points, shade.weights_);
    for (std::size_t i = 0; i < points.size(); ++i) {
      weights[i] = points[i].weight * kExact / std::max(std::abs(rest[i]), kExact);
    }
  }
  return shade;
}

}  // namespace houghstream::fusion
