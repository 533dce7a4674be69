#include "tools/render/world/optics/photo.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "tools/render/world/optics/pixel_noise.hpp"

namespace houghstream {
namespace {

constexpr int kLevels = 4096;

// Linear 0..1 in steps to sRGB bytes (IEC 61966-2-1).
std::array<std::uint8_t, kLevels> make_srgb_table() {
  std::array<std::uint8_t, kLevels> table{};
  for (int i = 0; i < kLevels; ++i) {
    const double value = (i + 0.5) / kLevels;
    const double coded = value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1.0 / 2.4) - 0.055;
    table[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(std::lround(255.0 * coded));
  }
  return table;
}

// Cameras do not follow the scene's brightness all the way: dark rooms stay darker.
double automatic_exposure(const cv::Mat& radiance, const PhotoSettings& settings) {
  constexpr double kFollow = 0.8;
  const cv::Scalar mean = cv::mean(cv::min(radiance, 1.5));
  const double level = std::max(1e-3, (mean[0] + mean[1] + mean[2]) / 3.0);
  return settings.exposure_bias * std::pow(settings.mean_level / level, kFollow);
}

}  // namespace

cv::Mat take_photo(const cv::Mat& radiance, const PhotoSettings& settings, std::uint64_t seed) {
  static const std::array<std::uint8_t, kLevels> kSrgb = make_srgb_table();
  cv::Mat blurred;
  cv::GaussianBlur(radiance, blurred, {5, 5}, settings.blur_px);
  const auto exposure = static_cast<float>(automatic_exposure(radiance, settings));
  const Eigen::Vector3f gain = exposure * settings.white_balance_bgr;
  const auto shot_sq = static_cast<float>(settings.shot_noise * settings.shot_noise);
  const auto read_sq = static_cast<float>(settings.read_noise * settings.read_noise);
  const auto falloff = static_cast<float>(settings.vignetting /
                                          (0.25 * (radiance.cols * radiance.cols + radiance.rows * radiance.rows)));
  cv::Mat picture(radiance.size(), CV_8UC3);
  for (int y = 0; y < picture.rows; ++y) {
    const auto* in = blurred.ptr<cv::Vec3f>(y);
    auto* out = picture.ptr<cv::Vec3b>(y);
    const float dy = static_cast<float>(y) - 0.5F * static_cast<float>(picture.rows);
    for (int x = 0; x < picture.cols; ++x) {
      const float dx = static_cast<float>(x) - 0.5F * static_cast<float>(picture.cols);
      const float vignette = 1.0F - falloff * (dx * dx + dy * dy);
      for (int c = 0; c < 3; ++c) {
        const float level = vignette * gain[c] * in[x][c];
        const auto index = (static_cast<std::uint64_t>(y) * 4096U + static_cast<std::uint64_t>(x)) * 3U +
                           static_cast<std::uint64_t>(c);
        const float noisy = level + std::sqrt(shot_sq * level + read_sq) * pixel_normal(seed, index);
        out[x][c] = kSrgb[static_cast<std::size_t>(std::clamp(noisy * kLevels, 0.0F, kLevels - 1.0F))];
      }
    }
  }
  return picture;
}

}  // namespace houghstream
