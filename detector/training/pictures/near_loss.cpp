#include "detector/training/pictures/near_loss.hpp"

#include <algorithm>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace houghstream {
namespace {

/// Where its values are high, depth stays.
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

void lose_near_depth(double limit, double kept, cv::Mat& depth, Random& random) {
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

}  // namespace houghstream
