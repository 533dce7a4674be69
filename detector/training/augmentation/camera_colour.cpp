#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "detector/training/augmentation/camera_randomisation.hpp"

namespace houghstream::training {
namespace {

constexpr int kLevels = 16384;  // levels of linear light

double linear_of(double coded) {  // IEC 61966-2-1, 0 to 1
  return coded <= 0.04045 ? coded / 12.92 : std::pow((coded + 0.055) / 1.055, 2.4);
}

double coded_of(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

const std::array<float, 256>& linear_table() {
  static const std::array<float, 256> kTable = [] {
    std::array<float, 256> table{};
    for (std::size_t i = 0; i < table.size(); ++i) {
      table[i] = static_cast<float>(linear_of(static_cast<double>(i) / 255.0));
    }
    return table;
  }();
  return kTable;
}

const std::vector<float>& coded_table() {
  static const std::vector<float> kTable = [] {
    std::vector<float> table(kLevels);
    for (int i = 0; i < kLevels; ++i) {
      table[static_cast<std::size_t>(i)] = static_cast<float>(coded_of(static_cast<double>(i) / (kLevels - 1)));
    }
    return table;
  }();
  return kTable;
}

/// Draws nearly normal numbers for the three channels of a pixel, deviation 1: each the sum of four uniforms of five
/// bits.
std::array<float, 3> normals(Random& random) {
  constexpr float kMean = 62.0F;
  constexpr float kDeviation = 18.466F;  // deviation of the sum: sqrt(4 * (32^2 - 1) / 12)
  std::uint64_t bits = random.bits();
  std::array<float, 3> out{};
  for (float& number : out) {
    const auto sum = (bits & 31U) + ((bits >> 5U) & 31U) + ((bits >> 10U) & 31U) + ((bits >> 15U) & 31U);
    number = (static_cast<float>(sum) - kMean) * (1.0F / kDeviation);
    bits >>= 20U;
  }
  return out;
}

void blur(const ColourVariation& camera, cv::Mat& colour) {
  constexpr double kMinBlur = 0.25;  // below, a Gaussian is one pixel
  if (camera.blur_px > kMinBlur) cv::GaussianBlur(colour, colour, {0, 0}, camera.blur_px);
  if (camera.motion_px < 1.0) return;
  const int reach = static_cast<int>(std::ceil(0.5 * camera.motion_px));
  cv::Mat kernel = cv::Mat::zeros(2 * reach + 1, 2 * reach + 1, CV_32FC1);
  constexpr int kSteps = 32;
  for (int i = 0; i < kSteps; ++i) {
    const double way = camera.motion_px * ((i + 0.5) / kSteps - 0.5);
    const int x = reach + static_cast<int>(std::lround(way * std::cos(camera.motion_angle)));
    const int y = reach + static_cast<int>(std::lround(way * std::sin(camera.motion_angle)));
    kernel.at<float>(y, x) += 1.0F / kSteps;
  }
  cv::filter2D(colour, colour, -1, kernel, {-1, -1}, 0.0, cv::BORDER_REPLICATE);
}

/// Returns the gain of the automatic exposure, times its error.
double exposure(const ColourVariation& camera, const cv::Mat& colour) {
  constexpr double kMiddleGrey = 110.0;
  constexpr double kMaxStops = 1.0;
  const cv::Scalar mean = cv::mean(colour);
  const double level = std::max(1.0, (mean[0] + mean[1] + mean[2]) / 3.0);
  const double followed = 2.2 * std::log2(kMiddleGrey / level);  // coded values go with the light to the power of 1/2.2
  return std::exp2(camera.exposure_stops + camera.exposure_follow * std::clamp(followed, -kMaxStops, kMaxStops));
}

/// Returns the light that the sensor counts, white-balanced and clipped: CV_16UC3, 0 to kLevels - 1.
cv::Mat sensed(const ColourVariation& camera, const cv::Mat& colour, Random& random) {
  const double gain = exposure(camera, colour);
  std::array<std::array<float, 256>, 3> light{};
  std::array<std::array<float, 256>, 3> sigma{};
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t v = 0; v < 256; ++v) {
      const double level = camera.flare + gain * linear_table()[v] * camera.white_balance_bgr[c];
      light[c][v] = static_cast<float>(level);
      sigma[c][v] = static_cast<float>(
          std::sqrt(camera.shot_noise * camera.shot_noise * level + camera.read_noise * camera.read_noise));
    }
  }
  const double centre_x = camera.vignette_centre[0] * colour.cols;
  const double centre_y = camera.vignette_centre[1] * colour.rows;
  const double max_x = std::max(centre_x, colour.cols - centre_x);
  const double max_y = std::max(centre_y, colour.rows - centre_y);
  const auto falloff = static_cast<float>(camera.vignetting / (max_x * max_x + max_y * max_y));
  const bool noisy = camera.shot_noise > 0.0 || camera.read_noise > 0.0;
  cv::Mat out(colour.size(), CV_16UC3);
  for (int y = 0; y < colour.rows; ++y) {
    const auto* in_row = colour.ptr<cv::Vec3b>(y);
    auto* out_row = out.ptr<cv::Vec3w>(y);
    const auto dy = static_cast<float>(y - centre_y);
    for (int x = 0; x < colour.cols; ++x) {
      const auto dx = static_cast<float>(x - centre_x);
      const float kept = 1.0F - falloff * (dx * dx + dy * dy);
      const std::array<float, 3> noise = noisy ? normals(random) : std::array<float, 3>{};
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint8_t coded = in_row[x][static_cast<int>(c)];
        const float value = kept * (light[c][coded] + sigma[c][coded] * noise[c]);
        out_row[x][static_cast<int>(c)] =
            cv::saturate_cast<std::uint16_t>(std::clamp(value, 0.0F, 1.0F) * (kLevels - 1));
      }
    }
  }
  return out;
}

/// Keeps one channel a pixel, and makes up the others from neighbours as a camera does.
void demosaic(const ColourVariation& camera, cv::Mat& raw) {
  if (camera.bayer < 0 || raw.rows < 8 || raw.cols < 8) return;
  const int first_x = camera.bayer % 2;
  const int first_y = camera.bayer / 2;
  cv::Mat mosaic(raw.size(), CV_16UC1);
  for (int y = 0; y < raw.rows; ++y) {
    const auto* in_row = raw.ptr<cv::Vec3w>(y);
    auto* out_row = mosaic.ptr<std::uint16_t>(y);
    const int channel_y = (y + first_y) % 2;
    for (int x = 0; x < raw.cols; ++x) out_row[x] = in_row[x][channel_y + (x + first_x) % 2];  // B G, then G R
  }
  // OpenCV names a mosaic by what lies at the second row's second and third pixel.
  constexpr std::array<int, 4> kPlain{cv::COLOR_BayerRG2BGR, cv::COLOR_BayerGR2BGR, cv::COLOR_BayerGB2BGR,
                                      cv::COLOR_BayerBG2BGR};
  constexpr std::array<int, 4> kAlongEdges{cv::COLOR_BayerRG2BGR_EA, cv::COLOR_BayerGR2BGR_EA, cv::COLOR_BayerGB2BGR_EA,
                                           cv::COLOR_BayerBG2BGR_EA};
  const auto kind = static_cast<std::size_t>(camera.bayer);
  cv::demosaicing(mosaic, raw, camera.edge_aware ? kAlongEdges[kind] : kPlain[kind]);
}

/// Converts linear light to coded bytes.
cv::Mat toned(const ColourVariation& camera, const cv::Mat& raw) {
  constexpr int kSteps = 1024;  // steps of coded values, between which the curve is straight
  std::array<float, kSteps + 2> curve{};
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const double value = std::pow(std::min(1.0, static_cast<double>(i) / kSteps), camera.gamma);
    const double s_curve = value * value * (3.0 - 2.0 * value);
    const double contrasty = value + camera.contrast * (s_curve - value);
    const double levelled = (contrasty - camera.black) / (camera.white - camera.black);
    curve[i] = static_cast<float>(255.0 * std::clamp(levelled, 0.0, 1.0));
  }
  std::array<std::uint8_t, kLevels> table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    const float at = coded_table()[i] * kSteps;
    const auto below = static_cast<std::size_t>(at);
    const float value = curve[below] + (at - static_cast<float>(below)) * (curve[below + 1] - curve[below]);
    table[i] = static_cast<std::uint8_t>(std::clamp(value + 0.5F, 0.0F, 255.0F));
  }
  cv::Mat out(raw.size(), CV_8UC3);
  for (int y = 0; y < raw.rows; ++y) {
    const auto* in_row = raw.ptr<std::uint16_t>(y);
    auto* out_row = out.ptr<std::uint8_t>(y);
    for (int i = 0; i < 3 * raw.cols; ++i) out_row[i] = table[in_row[i]];
  }
  return out;
}

/// Changes saturation about each colour's grey (ITU-R BT.601), and turns all hues about the grey axis.
void render_colours(const ColourVariation& camera, cv::Mat& colour) {
  if (camera.saturation == 1.0 && camera.hue_rotation == 0.0) return;
  const double cosine = std::cos(camera.hue_rotation);
  const double sine = std::sin(camera.hue_rotation) / std::sqrt(3.0);
  const double third = (1.0 - cosine) / 3.0;
  const cv::Matx33d rotation(cosine + third, third - sine, third + sine,  //
                             third + sine, cosine + third, third - sine,  //
                             third - sine, third + sine, cosine + third);
  const cv::Matx33d grey(0.114, 0.587, 0.299, 0.114, 0.587, 0.299, 0.114, 0.587, 0.299);
  cv::transform(colour, colour, cv::Mat((grey + camera.saturation * (cv::Matx33d::eye() - grey)) * rotation));
}

void sharpen(const ColourVariation& camera, cv::Mat& colour) {
  if (camera.sharpening <= 0.0) return;
  cv::Mat soft;
  cv::GaussianBlur(colour, soft, {0, 0}, camera.sharpening_px);
  cv::addWeighted(colour, 1.0 + camera.sharpening, soft, -camera.sharpening, 0.0, colour);
}

/// Halves the chroma: two neighbours keep their brightness and share their difference from it.
void halve_chroma(cv::Mat& colour) {
  for (int y = 0; y < colour.rows; ++y) {
    auto* row = colour.ptr<cv::Vec3b>(y);
    for (int x = 0; x + 1 < colour.cols; x += 2) {
      const cv::Vec3i left(row[x]);
      const cv::Vec3i right(row[x + 1]);
      const cv::Vec3i difference = left - right;
      const int brighter = (29 * difference[0] + 150 * difference[1] + 77 * difference[2]) / 256;  // ITU-R BT.601
      for (int c = 0; c < 3; ++c) {
        row[x][c] = cv::saturate_cast<std::uint8_t>((left[c] + right[c] + brighter + 1) / 2);
        row[x + 1][c] = cv::saturate_cast<std::uint8_t>((left[c] + right[c] - brighter + 1) / 2);
      }
    }
  }
}

void compress(int quality, cv::Mat& colour) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".jpg", colour, bytes, {cv::IMWRITE_JPEG_QUALITY, quality});
  cv::imdecode(bytes, cv::IMREAD_COLOR, &colour);
}

bool counts_light(const ColourVariation& camera) {
  const ColourVariation none;
  return camera.exposure_stops != 0.0 || camera.exposure_follow > 0.0 || camera.vignetting > 0.0 ||
         camera.shot_noise > 0.0 || camera.read_noise > 0.0 || camera.flare > 0.0 ||
         camera.white_balance_bgr != none.white_balance_bgr || camera.bayer >= 0 || camera.gamma != 1.0 ||
         camera.contrast != 0.0 || camera.black != 0.0 || camera.white != 1.0;
}

}  // namespace

void apply_colour(const CameraRandomisation& camera, cv::Mat& colour, Random& random) {
  const ColourVariation& made = camera.colour;
  blur(made, colour);
  if (counts_light(made)) {
    cv::Mat raw = sensed(made, colour, random);
    demosaic(made, raw);
    colour = toned(made, raw);
  }
  render_colours(made, colour);
  sharpen(made, colour);
  if (made.half_chroma) halve_chroma(colour);
  if (made.jpeg_quality > 0) compress(made.jpeg_quality, colour);
}

}  // namespace houghstream::training
