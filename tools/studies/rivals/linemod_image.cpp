#include "tools/studies/rivals/linemod_image.hpp"

#include <algorithm>
#include <numeric>
#include <opencv2/imgproc.hpp>

namespace houghstream {
namespace {

int round_up(int length, int step) {
  return (length + step - 1) / step * step;
}

}  // namespace

std::vector<cv::Mat> linemod_images(const RgbdFrame& frame, cv::Size largest) {
  constexpr int kAlignment = 16;
  constexpr int kBorder = 2 * 8 * kLinemodSteps[0];
  constexpr int kHeightStep = std::lcm(kLinemodSteps[0], 2 * kLinemodSteps[1]);
  constexpr int kWidthStep = std::lcm(kHeightStep, 2 * kAlignment);
  const cv::Size size = frame.colour.size();
  const int right = round_up(std::max(size.width, largest.width + kBorder), kWidthStep) - size.width;
  const int below = round_up(std::max(size.height, largest.height + kBorder), kHeightStep) - size.height;
  cv::Mat colour;
  cv::Mat depth_mm;
  cv::copyMakeBorder(frame.colour, colour, 0, below, 0, right, cv::BORDER_REPLICATE);
  cv::copyMakeBorder(depth_to_millimetres(frame.depth), depth_mm, 0, below, 0, right, cv::BORDER_CONSTANT,
                     cv::Scalar::all(0));
  return {colour, depth_mm};
}

}  // namespace houghstream
