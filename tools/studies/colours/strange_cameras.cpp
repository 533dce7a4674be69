#include "tools/studies/colours/strange_cameras.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>

namespace houghstream::colours {
namespace {

/// Returns linear sRGB of a black body, of luminance 1. Its chromaticity follows Kim et al., US patent 7024034 (2006).
Eigen::Vector3d black_body_rgb(double kelvin) {
  const double t = 1e3 / kelvin;
  const double x = kelvin < 4000.0 ? -0.2661239 * t * t * t - 0.2343589 * t * t + 0.8776956 * t + 0.179910
                                   : -3.0258469 * t * t * t + 2.1070379 * t * t + 0.2226347 * t + 0.240390;
  const double y = kelvin < 4000.0 ? -0.9549476 * x * x * x - 1.37418593 * x * x + 2.09137015 * x - 0.16748867
                                   : 3.0817580 * x * x * x - 5.87338670 * x * x + 3.75112997 * x - 0.37001483;
  Eigen::Matrix3d xyz_of_rgb;  // IEC 61966-2-1
  xyz_of_rgb << 0.4124, 0.3576, 0.1805, 0.2126, 0.7152, 0.0722, 0.0193, 0.1192, 0.9505;
  return xyz_of_rgb.inverse() * Eigen::Vector3d(x / y, 1.0, (1.0 - x - y) / y);
}

/// Returns gains of linear blue, green and red; green stays.
std::array<double, 3> white_balance(double kelvin) {
  constexpr double kTakenFor = 5500.0;
  const Eigen::Vector3d gain = black_body_rgb(kelvin).cwiseQuotient(black_body_rgb(kTakenFor));
  return {gain.z() / gain.y(), 1.0, gain.x() / gain.y()};
}

}  // namespace

std::string StrangeCamera::name() const {
  return fmt::format("{:.0f} K, saturation {:.2f}, gamma {:.2f}", white_balance_k, camera.colour.saturation,
                     camera.colour.gamma);
}

std::vector<StrangeCamera> strange_cameras(int count, std::uint64_t seed) {
  constexpr double kWarmest = 1e6 / 3000.0;  // mired
  constexpr double kColdest = 1e6 / 8000.0;
  std::vector<StrangeCamera> cameras;
  for (int i = 0; i < count; ++i) {
    Random random = Random::for_item(seed, static_cast<std::uint64_t>(i));
    const double place = (i + random.uniform()) / count;
    StrangeCamera& camera = cameras.emplace_back();
    camera.white_balance_k = 1e6 / (kColdest + place * (kWarmest - kColdest));
    camera.camera.colour.white_balance_bgr = white_balance(camera.white_balance_k);
    camera.camera.colour.saturation = std::exp(random.uniform(std::log(0.6), std::log(1.6)));
    camera.camera.colour.gamma = std::exp(random.uniform(std::log(0.7), std::log(1.5)));
  }
  return cameras;
}

}  // namespace houghstream::colours
