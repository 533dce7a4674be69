#include "pipeline/types/detection.hpp"

namespace houghstream {

float box_iou(const cv::Rect2f& a, const cv::Rect2f& b) {
  const float intersection = (a & b).area();
  const float joint = a.area() + b.area() - intersection;
  return joint > 0.0F ? intersection / joint : 0.0F;
}

}  // namespace houghstream
