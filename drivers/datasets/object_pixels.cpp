#include "drivers/datasets/object_pixels.hpp"

#include <cmath>

namespace houghstream {

int count_depth_pixels(const cv::Mat& depth, const cv::Mat& mask) {
  int count = 0;
  for (int y = 0; y < depth.rows; ++y) {
    for (int x = 0; x < depth.cols; ++x) {
      count += mask.at<std::uint8_t>(y, x) != 0 && std::isfinite(depth.at<float>(y, x)) ? 1 : 0;
    }
  }
  return count;
}

std::vector<ColouredPoint> object_points(const cv::Mat& colour, const cv::Mat& depth, const cv::Mat& mask,
                                         const Camera& camera) {
  std::vector<ColouredPoint> points;
  for (int y = 0; y < depth.rows; ++y) {
    for (int x = 0; x < depth.cols; ++x) {
      const float z = depth.at<float>(y, x);
      if (mask.at<std::uint8_t>(y, x) == 0 || !std::isfinite(z)) continue;
      points.push_back({camera.backproject(x, y, z), colour.at<cv::Vec3b>(y, x)});
    }
  }
  return points;
}

}  // namespace houghstream
