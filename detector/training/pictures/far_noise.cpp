#include "detector/training/pictures/far_noise.hpp"

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "detector/training/pictures/composites.hpp"

namespace houghstream {

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

}  // namespace houghstream
