#include "tools/render/world/optics/time_of_flight.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "pipeline/base/no_value.hpp"
#include "tools/render/world/objects/pixel_noise.hpp"

namespace houghstream::world {
namespace {

class TimeOfFlight {
 public:
  TimeOfFlight(const SensorView& view, const TimeOfFlightSettings& settings, std::uint64_t seed)
      : view_(view), settings_(settings), seed_(seed), image_({0, 0}, view.depth.size()) {}

  float measure(const cv::Point& pixel) const {
    const double z = depth(pixel);
    if (std::isnan(z)) return kNoValue;
    const double amplitude = returned_amplitude(view_, pixel);
    if (amplitude < settings_.min_amplitude) return kNoValue;
    const auto index = static_cast<std::uint64_t>(pixel.y) * 4096U + static_cast<std::uint64_t>(pixel.x);
    const double noise = time_of_flight_sigma(amplitude, settings_) * pixel_normal(seed_ + 1, index);
    const double seen = mixed(pixel, index).value_or(z + multipath_bias(pixel, z)) + noise;
    if (seen < settings_.near_m || seen > settings_.far_m) return kNoValue;
    return static_cast<float>(std::round(1000.0 * seen) / 1000.0);
  }

 private:
  double depth(const cv::Point& pixel) const { return view_.depth.at<float>(pixel); }

  /// Returns the depth of a flying pixel between the nearest and the farthest of its neighbours, each weighted by the
  /// light that returns from the part of the pixel that it fills.
  std::optional<double> mixed(const cv::Point& pixel, std::uint64_t index) const {
    cv::Point nearest = pixel;
    cv::Point farthest = pixel;
    for (int y = std::max(pixel.y - 1, 0); y <= std::min(pixel.y + 1, image_.height - 1); ++y) {
      for (int x = std::max(pixel.x - 1, 0); x <= std::min(pixel.x + 1, image_.width - 1); ++x) {
        if (depth({x, y}) < depth(nearest)) nearest = {x, y};  // false where one is NaN
        if (depth({x, y}) > depth(farthest)) farthest = {x, y};
      }
    }
    if (depth(farthest) - depth(nearest) <= settings_.edge_step * depth(nearest)) return std::nullopt;
    if (pixel_uniform(seed_ + 2, index) >= settings_.flying_fraction) return std::nullopt;
    const double filled = pixel_uniform(seed_ + 3, index);
    const double near_light = filled * returned_amplitude(view_, nearest);
    const double far_light = (1.0 - filled) * returned_amplitude(view_, farthest);
    if (near_light + far_light <= 0.0) return std::nullopt;
    return (near_light * depth(nearest) + far_light * depth(farthest)) / (near_light + far_light);
  }

  /// A pixel that lies behind the mean of its surroundings is in a corner that lights itself.
  double multipath_bias(const cv::Point& pixel, double z) const {
    constexpr int kSteps = 3;  // each way: the surroundings are seen at 7x7 places
    double sum = 0.0;
    int count = 0;
    for (int j = -kSteps; j <= kSteps; ++j) {
      for (int i = -kSteps; i <= kSteps; ++i) {
        const cv::Point offset(static_cast<int>(std::lround(i * settings_.multipath_reach_px / kSteps)),
                               static_cast<int>(std::lround(j * settings_.multipath_reach_px / kSteps)));
        // Opposite places count together or not at all: the border of the image and a slope make no corner.
        if (!image_.contains(pixel + offset) || !image_.contains(pixel - offset)) continue;
        const double pair_mean = 0.5 * (depth(pixel + offset) + depth(pixel - offset));
        if (!(std::abs(depth(pixel + offset) - z) < settings_.multipath_reach_m)) continue;
        if (!(std::abs(depth(pixel - offset) - z) < settings_.multipath_reach_m)) continue;
        sum += pair_mean;
        ++count;
      }
    }
    return count == 0 ? 0.0 : settings_.multipath * std::max(0.0, z - sum / count);
  }

  const SensorView& view_;
  const TimeOfFlightSettings& settings_;
  std::uint64_t seed_;
  cv::Rect image_;
};

}  // namespace

double returned_amplitude(const SensorView& view, const cv::Point& pixel) {
  const double z = view.depth.at<float>(pixel);
  const double specular = view.specular.at<float>(pixel);
  return view.reflectance.at<float>(pixel) * (1.0 - 0.6 * specular) * view.cos_incidence.at<float>(pixel) / (z * z);
}

double time_of_flight_sigma(double amplitude, const TimeOfFlightSettings& settings) {
  return std::hypot(settings.floor_m, settings.light_m / amplitude);
}

cv::Mat measure_time_of_flight(const SensorView& view, const TimeOfFlightSettings& settings, std::uint64_t seed) {
  const TimeOfFlight sensor(view, settings, seed);
  cv::Mat measured(view.depth.size(), CV_32FC1);
  for (int y = 0; y < measured.rows; ++y) {
    for (int x = 0; x < measured.cols; ++x) measured.at<float>(y, x) = sensor.measure({x, y});
  }
  return measured;
}

}  // namespace houghstream::world
