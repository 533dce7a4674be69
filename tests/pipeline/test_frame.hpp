#pragma once

#include <cmath>
#include <limits>

#include "pipeline/types/frame.hpp"

namespace houghstream {

/// Returns a small frame with a smooth image, a slope of depth in whole millimetres, and holes.
inline RgbdFrame make_test_frame(std::int64_t utime, int width = 64, int height = 48) {
  RgbdFrame frame;
  frame.id.utime = utime;
  frame.camera = {width, height, 0.9 * width, 0.9 * width, 0.5 * width, 0.5 * height};
  frame.colour.create(height, width, CV_8UC3);
  frame.depth.create(height, width, CV_32FC1);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      frame.colour.at<cv::Vec3b>(y, x) =
          cv::Vec3b(static_cast<uchar>(x * 255 / width), 100, static_cast<uchar>(y * 255 / height));
      const bool hole = x % 13 == 0;
      frame.depth.at<float>(y, x) =
          hole ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(600 + 3 * x + y) * 1e-3F;
    }
  }
  frame.stages = {{"capture.read", 1200}};
  return frame;
}

/// Returns whether two depth images are equal bit for bit, NaN with NaN.
inline bool same_depth(const cv::Mat& a, const cv::Mat& b) {
  if (a.size() != b.size()) return false;
  for (int y = 0; y < a.rows; ++y) {
    for (int x = 0; x < a.cols; ++x) {
      const float left = a.at<float>(y, x);
      const float right = b.at<float>(y, x);
      if (!(left == right || (std::isnan(left) && std::isnan(right)))) return false;
    }
  }
  return true;
}

}  // namespace houghstream
