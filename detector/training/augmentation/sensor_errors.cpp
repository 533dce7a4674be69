#include "detector/training/augmentation/sensor_errors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "detector/training/augmentation/composites.hpp"

namespace houghstream::training {
namespace {

/// Grows near surfaces: each pixel takes the nearest depth around it; holes lend none and take none.
cv::Mat grown(const cv::Mat& depth, int right_px, int down_px) {
  constexpr double kMaxDistance = 1e6;
  cv::Mat out = depth.clone();
  cv::patchNaNs(out, kMaxDistance);
  cv::erode(out, out, cv::getStructuringElement(cv::MORPH_RECT, {2 * right_px + 1, 2 * down_px + 1}));
  out.setTo(std::numeric_limits<float>::quiet_NaN(), ~(depth == depth));  // vectorised, != may call two NaN equal
  return out;
}

/// Moves an image to the right and down, at most `max_px`; the border's pixels fill what is left free.
cv::Mat moved(const cv::Mat& depth, int right_px, int down_px, int max_px) {
  cv::Mat padded;
  cv::copyMakeBorder(depth, padded, max_px, max_px, max_px, max_px, cv::BORDER_REPLICATE);
  return padded(cv::Rect({max_px - right_px, max_px - down_px}, depth.size())).clone();
}

/// Makes smooth errors in cells of random size, metres.
cv::Mat ripples(cv::Size size, double sigma, Random& random) {
  const int cell_px = random.between(6, 30);
  cv::Mat coarse(size.height / cell_px + 2, size.width / cell_px + 2, CV_32FC1);
  for (int y = 0; y < coarse.rows; ++y) {
    for (int x = 0; x < coarse.cols; ++x) coarse.at<float>(y, x) = static_cast<float>(sigma * random.normal());
  }
  cv::Mat out;
  cv::resize(coarse, out, size, 0, 0, cv::INTER_CUBIC);
  return out;
}

/// Makes smooth noise; depth stays where its values are high.
cv::Mat smooth_noise(cv::Size size, Random& random) {
  const int cell_px = random.between(6, 40);
  cv::Mat coarse(size.height / cell_px + 2, size.width / cell_px + 2, CV_32FC1);
  for (int y = 0; y < coarse.rows; ++y) {
    for (int x = 0; x < coarse.cols; ++x) coarse.at<float>(y, x) = static_cast<float>(random.normal());
  }
  cv::Mat noise;
  cv::resize(coarse, noise, size, 0, 0, cv::INTER_CUBIC);
  return noise;
}

}  // namespace

void misregister(double strength, cv::Mat& depth, Random& random) {
  constexpr double kMax = 2.0;  // pixels
  const int max_px = static_cast<int>(std::lround(strength * kMax));
  if (max_px <= 0) return;
  const int wider = random.between(0, max_px);
  const int higher = random.between(0, max_px);
  const int right = random.between(-max_px, max_px);
  const int down = random.between(-max_px, max_px);
  depth = moved(grown(depth, wider, higher), right, down, max_px);
}

TrainingView perturb_shape(const TrainingView& view, double strength, Random& random) {
  constexpr double kMaxSlope = 0.07;    // metres of depth a metre to the side
  constexpr double kMaxRipple = 0.002;  // metres, standard deviation
  if (strength <= 0.0) return view;
  const Eigen::Vector3d centre = view.T_camera_object.translation();
  const double metres = strength * kMaxSlope * view.frame.camera.metres_per_px(centre.z());
  const double right = metres * random.uniform(-1.0, 1.0);
  const double down = metres * random.uniform(-1.0, 1.0);
  const Eigen::Vector2d middle = view.frame.camera.project(centre);
  const cv::Mat error = ripples(view.frame.depth.size(), strength * kMaxRipple * random.uniform(), random);
  cv::Mat depth = view.frame.depth + error;  // an image of its own: the view's stays as it is
  for (int y = 0; y < error.rows; ++y) {
    for (int x = 0; x < error.cols; ++x) {
      depth.at<float>(y, x) += static_cast<float>(right * (x - middle.x()) + down * (y - middle.y()));
    }
  }
  TrainingView out = view;
  out.frame.depth = depth;
  return out;
}

void perturb_appearance_in(const cv::Mat& mask, double strength, Random& random, cv::Mat& colour) {
  constexpr double kCast = 0.15;       // stops, each channel
  constexpr double kGamma = 0.3;       // powers of two
  constexpr double kUneven = 0.35;     // stops, deviation
  constexpr double kMaxBlur_px = 1.5;  // standard deviation
  if (strength <= 0.0) return;
  const double saturation = std::exp2(strength * random.uniform(-0.8, 0.5));
  const double gamma = std::exp2(strength * kGamma * random.uniform(-1.0, 1.0));
  std::array<double, 3> gain{};
  for (double& channel : gain) channel = std::exp2(strength * kCast * random.uniform(-1.0, 1.0));
  cv::Mat coarse(3, 3, CV_32FC1);
  const double uneven = strength * kUneven * random.uniform();
  for (int y = 0; y < coarse.rows; ++y) {
    for (int x = 0; x < coarse.cols; ++x)
      coarse.at<float>(y, x) = static_cast<float>(std::exp2(uneven * random.normal()));
  }
  cv::Mat light;
  cv::resize(coarse, light, mask.size(), 0, 0, cv::INTER_CUBIC);
  const double blur_px = strength * kMaxBlur_px * random.uniform(-1.0, 1.0);
  if (blur_px > 0.2) {
    cv::Mat blurred;
    cv::GaussianBlur(colour, blurred, {0, 0}, blur_px);
    blurred.copyTo(colour, mask);
  }
  std::array<double, 256> tone{};
  for (std::size_t v = 0; v < tone.size(); ++v) tone[v] = 255.0 * std::pow(static_cast<double>(v) / 255.0, gamma);
  for (int y = 0; y < mask.rows; ++y) {
    for (int x = 0; x < mask.cols; ++x) {
      if (mask.at<std::uint8_t>(y, x) == 0) continue;
      cv::Vec3b& pixel = colour.at<cv::Vec3b>(y, x);
      std::array<double, 3> bgr{};
      for (std::size_t c = 0; c < 3; ++c) bgr[c] = light.at<float>(y, x) * gain[c] * tone[pixel[static_cast<int>(c)]];
      const double grey = 0.114 * bgr[0] + 0.587 * bgr[1] + 0.299 * bgr[2];  // ITU-R BT.601
      for (std::size_t c = 0; c < 3; ++c)
        pixel[static_cast<int>(c)] = cv::saturate_cast<std::uint8_t>(grey + saturation * (bgr[c] - grey));
    }
  }
}

TrainingView perturb_appearance(const TrainingView& view, double strength, Random& random) {
  TrainingView out = view;
  out.frame.colour = view.frame.colour.clone();  // the view's own pixels stay as they are
  perturb_appearance_in(out.mask, strength, random, out.frame.colour);
  return out;
}

void drop_near_depth(double limit, double kept, cv::Mat& depth, Random& random) {
  const cv::Mat noise = smooth_noise(depth.size(), random);
  const cv::Mat near = depth < limit;  // false for NaN
  std::vector<float> values;
  for (int y = 0; y < depth.rows; ++y) {
    for (int x = 0; x < depth.cols; ++x) {
      if (near.at<std::uint8_t>(y, x) != 0) values.push_back(noise.at<float>(y, x));
    }
  }
  const auto lost = static_cast<std::size_t>((1.0 - kept) * static_cast<double>(values.size()));
  if (lost == 0) return;
  const auto last_lost = values.begin() + static_cast<std::ptrdiff_t>(lost - 1);
  std::nth_element(values.begin(), last_lost, values.end());
  depth.setTo(std::numeric_limits<float>::quiet_NaN(), near & (noise <= *last_lost));
}

void add_far_noise(double distance, double ratio, cv::Mat& depth, Random& random) {
  const double far = axial_noise(ratio * distance);
  const double near = axial_noise(distance);
  if (!(far > near)) return;
  const cv::Size size(static_cast<int>(std::ceil(depth.cols / ratio)), static_cast<int>(std::ceil(depth.rows / ratio)));
  cv::Mat noise(size, CV_32FC1);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) noise.at<float>(y, x) = static_cast<float>(random.normal());
  }
  constexpr int kWindow = 3;  // pixels: the sensor matches windows, so that neighbours share their error
  cv::boxFilter(noise, noise, CV_32F, {kWindow, kWindow});
  cv::resize(noise, noise, depth.size(), 0, 0, cv::INTER_LINEAR);
  depth += noise * (kWindow * std::sqrt(far * far - near * near));  // the mean of n has 1 / sqrt(n) of the deviation
}

}  // namespace houghstream::training
