#include "tools/render/world/optics/photo.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "tools/render/world/objects/pixel_noise.hpp"

namespace houghstream::world {
namespace {

constexpr int kLevels = 4096;

// Returns the table from linear 0..1 in steps to sRGB bytes (IEC 61966-2-1).
std::array<std::uint8_t, kLevels> make_srgb_table() {
  std::array<std::uint8_t, kLevels> table{};
  for (int i = 0; i < kLevels; ++i) {
    const double value = (i + 0.5) / kLevels;
    const double coded = value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1.0 / 2.4) - 0.055;
    table[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(std::lround(255.0 * coded));
  }
  return table;
}

}  // namespace

double automatic_exposure(const cv::Mat& radiance, const ColourCameraSettings& settings) {
  constexpr double kFollow = 0.8;
  const cv::Scalar mean = cv::mean(cv::min(radiance, 1.5));
  const double level = std::max(1e-3, (mean[0] + mean[1] + mean[2]) / 3.0);
  return settings.exposure_bias * std::pow(settings.mean_level / level, kFollow);
}

cv::Mat simulate_colour_camera(const cv::Mat& radiance, const ColourCameraSettings& settings, std::uint64_t seed) {
  static const std::array<std::uint8_t, kLevels> kSrgb = make_srgb_table();
  cv::Mat blurred;
  cv::GaussianBlur(radiance, blurred, {5, 5}, settings.blur_px);
  const auto exposure =
      static_cast<float>(settings.exposure ? *settings.exposure : automatic_exposure(radiance, settings));
  const Eigen::Vector3f gain = exposure * settings.white_balance_bgr;
  const auto shot_sq = static_cast<float>(settings.shot_noise * settings.shot_noise);
  const auto read_sq = static_cast<float>(settings.read_noise * settings.read_noise);
  const auto falloff = static_cast<float>(settings.vignetting /
                                          (0.25 * (radiance.cols * radiance.cols + radiance.rows * radiance.rows)));
  cv::Mat image(radiance.size(), CV_8UC3);
  for (int y = 0; y < image.rows; ++y) {
    const auto* in = blurred.ptr<cv::Vec3f>(y);
    auto* out = image.ptr<cv::Vec3b>(y);
    const float dy = static_cast<float>(y) - 0.5F * static_cast<float>(image.rows);
    for (int x = 0; x < image.cols; ++x) {
      const float dx = static_cast<float>(x) - 0.5F * static_cast<float>(image.cols);
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
  return image;
}

ColourResponse other_colour_camera() {
  ColourResponse response;
  response.further_vignetting = 0.15;
  response.white_balance_bgr = {1.08, 1.0, 0.93};
  response.gamma = 0.85;
  response.saturation = 1.25;
  response.sharpening = 0.6;
  return response;
}

cv::Mat apply_camera_response(const cv::Mat& photo, const ColourResponse& response) {
  const double corner_sq = 0.25 * (photo.cols * photo.cols + photo.rows * photo.rows);
  cv::Mat toned(photo.size(), CV_32FC3);
  for (int y = 0; y < photo.rows; ++y) {
    const double dy = y - 0.5 * (photo.rows - 1);
    for (int x = 0; x < photo.cols; ++x) {
      const double dx = x - 0.5 * (photo.cols - 1);
      const double vignette = 1.0 - response.further_vignetting * (dx * dx + dy * dy) / corner_sq;
      Eigen::Array3d bgr;
      for (int c = 0; c < 3; ++c) bgr[c] = photo.at<cv::Vec3b>(y, x)[c] / 255.0;
      bgr = (vignette * bgr * response.white_balance_bgr.array()).min(1.0).pow(response.gamma);
      const double grey = 0.114 * bgr[0] + 0.587 * bgr[1] + 0.299 * bgr[2];  // ITU-R BT.601
      bgr = 255.0 * (grey + response.saturation * (bgr - grey));
      toned.at<cv::Vec3f>(y, x) =
          cv::Vec3f(static_cast<float>(bgr[0]), static_cast<float>(bgr[1]), static_cast<float>(bgr[2]));
    }
  }
  if (response.sharpening > 0.0) {
    cv::Mat soft;
    cv::GaussianBlur(toned, soft, {0, 0}, response.sharpening_px);
    toned += response.sharpening * (toned - soft);
  }
  cv::Mat processed;
  toned.convertTo(processed, CV_8U);  // rounds, and clips to 0 to 255
  return processed;
}

}  // namespace houghstream::world
