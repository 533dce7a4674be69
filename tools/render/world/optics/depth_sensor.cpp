#include "tools/render/world/optics/depth_sensor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "pipeline/base/no_value.hpp"
#include "tools/render/world/objects/pixel_noise.hpp"

namespace houghstream::world {
namespace {

constexpr double kMaxIncidence = 1.45;  // radians; the model's terms grow without bound towards pi/2

// Returns normal noise, deviation 1, that neighbours share: the sensor matches windows, not pixels.
cv::Mat window_noise(const cv::Size& size, std::uint64_t seed) {
  cv::Mat noise(size, CV_32FC1);
  for (int y = 0; y < size.height; ++y) {
    auto* row = noise.ptr<float>(y);
    for (int x = 0; x < size.width; ++x)
      row[x] = pixel_normal(seed, static_cast<std::uint64_t>(y) * 4096U + static_cast<std::uint64_t>(x));
  }
  cv::boxFilter(noise, noise, CV_32F, {3, 3});
  return noise * 3.0;  // a mean of nine has a third of the deviation
}

// Returns 255 where depth changes by more than the settings' step within a pixel's neighbourhood.
cv::Mat depth_edges(const cv::Mat& depth, double relative_step) {
  cv::Mat known = depth.clone();
  cv::patchNaNs(known, 100.0);
  cv::Mat nearest;
  cv::Mat farthest;
  cv::erode(known, nearest, cv::Mat::ones(3, 3, CV_8UC1));
  cv::dilate(known, farthest, cv::Mat::ones(3, 3, CV_8UC1));
  return farthest - nearest > relative_step * nearest;
}

double incidence_rad(double cos_incidence) {
  return std::min(std::acos(std::clamp(cos_incidence, 0.0, 1.0)), kMaxIncidence);
}

class Sensor {
 public:
  Sensor(const SensorView& view, const Camera& camera, const DepthSensorSettings& settings, std::uint64_t seed)
      : view_(view),
        settings_(settings),
        seed_(seed),
        size_(view.depth.size()),
        shadow_(infrared_shadow(view.depth, camera, settings.baseline_m)),
        edges_(depth_edges(view.depth, settings.edge_step)),
        axial_noise_(window_noise(size_, seed + 1)),
        shift_x_(window_noise(size_, seed + 2)),
        shift_y_(window_noise(size_, seed + 3)),
        loss_noise_(window_noise(size_, seed + 4)) {}

  float measure(int x, int y) const {
    const double cosine = view_.cos_incidence.at<float>(y, x);
    const double incidence = incidence_rad(cosine);
    const double lateral = 0.8 + 0.035 * incidence / (M_PI / 2 - incidence);
    const int from_x = shifted(x, lateral * shift_x_.at<float>(y, x), size_.width);
    const int from_y = shifted(y, lateral * shift_y_.at<float>(y, x), size_.height);
    const double z = view_.depth.at<float>(from_y, from_x);
    if (std::isnan(z) || shadow_.at<std::uint8_t>(from_y, from_x) != 0 || lost(from_x, from_y, z)) return kNoValue;
    return quantised(z + pre_quantisation_sigma(z, cosine) * axial_noise_.at<float>(y, x));
  }

 private:
  static int shifted(int from, double by, int limit) {
    return std::clamp(from + static_cast<int>(std::lround(by)), 0, limit - 1);
  }

  bool lost(int x, int y, double z) const {
    const double wobble = std::max(0.2, 1.0 + 0.25 * loss_noise_.at<float>(y, x));
    const double cosine = view_.cos_incidence.at<float>(y, x);
    const double specular = view_.specular.at<float>(y, x);
    const double signal = view_.reflectance.at<float>(y, x) * (1.0 - 0.6 * specular) * cosine / (z * z);
    if (cosine < settings_.min_cosine * wobble || signal < settings_.min_signal * wobble) return true;
    const double cosine_sq = cosine * cosine;
    const double cosine_8 = cosine_sq * cosine_sq * cosine_sq * cosine_sq;
    const double cosine_32 = cosine_8 * cosine_8 * cosine_8 * cosine_8;
    const double mirrored = specular * cosine_32 * cosine_32;
    if (mirrored > settings_.glare * wobble) return true;
    const auto index = static_cast<std::uint64_t>(y) * 4096U + static_cast<std::uint64_t>(x);
    return edges_.at<std::uint8_t>(y, x) != 0 && pixel_uniform(seed_ + 5, index) < settings_.edge_loss;
  }

  // The published deviation is that of quantised depths: what quantisation adds (step / sqrt(12)) is taken off.
  double pre_quantisation_sigma(double z, double cosine) const {
    const double total = axial_sigma(z, cosine);
    const double step = depth_step(z, settings_);
    return std::sqrt(std::max(total * total - step * step / 12.0, 0.1 * total * total));
  }

  float quantised(double z) const {
    if (z < settings_.near_m || z > settings_.far_m) return kNoValue;
    const double scale = settings_.infrared_focal_px * settings_.baseline_m / settings_.disparity_step_px;
    const double steps = std::round(scale / z);
    return static_cast<float>(std::round(1000.0 * scale / steps) / 1000.0);
  }

  const SensorView& view_;
  const DepthSensorSettings& settings_;
  std::uint64_t seed_;
  cv::Size size_;
  cv::Mat shadow_, edges_, axial_noise_, shift_x_, shift_y_, loss_noise_;
};

}  // namespace

double axial_sigma(double z, double cos_incidence) {
  const double incidence = incidence_rad(cos_incidence);
  const double slant = incidence / (M_PI / 2 - incidence);
  const double oblique = incidence > M_PI / 3 ? 0.0001 / std::sqrt(z) * slant * slant : 0.0;
  return 0.0012 + 0.0019 * (z - 0.4) * (z - 0.4) + oblique;
}

double depth_step(double z, const DepthSensorSettings& settings) {
  return z * z * settings.disparity_step_px / (settings.infrared_focal_px * settings.baseline_m);
}

cv::Mat infrared_shadow(const cv::Mat& depth, const Camera& camera, double baseline_m) {
  cv::Mat shadow = cv::Mat::zeros(depth.size(), CV_8UC1);
  constexpr double kTolerancePx = 0.5;
  for (int y = 0; y < depth.rows; ++y) {
    // The projector sees a point at column u - f b / z of its own image. From right to left these columns fall as long
    // as nothing is hidden; a point that falls back behind one already passed is hidden by it.
    double minimum = std::numeric_limits<double>::infinity();
    for (int x = depth.cols - 1; x >= 0; --x) {
      const float z = depth.at<float>(y, x);
      if (std::isnan(z)) continue;
      const double column = x - camera.fx * baseline_m / z;
      if (column > minimum + kTolerancePx) shadow.at<std::uint8_t>(y, x) = 255;
      minimum = std::min(minimum, column);
    }
  }
  return shadow;
}

cv::Mat measure_depth(const SensorView& view, const Camera& camera, const DepthSensorSettings& settings,
                      std::uint64_t seed) {
  const Sensor sensor(view, camera, settings, seed);
  cv::Mat measured(view.depth.size(), CV_32FC1);
  for (int y = 0; y < measured.rows; ++y) {
    for (int x = 0; x < measured.cols; ++x) measured.at<float>(y, x) = sensor.measure(x, y);
  }
  return measured;
}

}  // namespace houghstream::world
