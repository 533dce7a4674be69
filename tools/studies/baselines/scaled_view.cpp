#include "tools/studies/baselines/scaled_view.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <opencv2/imgproc.hpp>

namespace houghstream {
namespace {

int round_up(int length, int step) {
  return (length + step - 1) / step * step;
}

constexpr int kMargin_px = 8;  // the gradients of an outline need what lies beside it

int even(int length) {
  return length + length % 2;
}

/// Returns the box of the object with the surroundings that resizing may read.
cv::Rect surroundings(const TrainingView& view, double scale) {
  const cv::Rect box = cv::boundingRect(view.mask);
  if (box.empty()) return box;
  const int margin = static_cast<int>(std::ceil(kMargin_px / scale));
  const cv::Rect wide(box.x - margin, box.y - margin, box.width + 2 * margin, box.height + 2 * margin);
  return wide & cv::Rect({0, 0}, view.mask.size());
}

cv::Mat with_margin(const cv::Mat& image, int border_type) {
  cv::Mat out;
  cv::copyMakeBorder(image, out, kMargin_px, even(image.rows) - image.rows + kMargin_px, kMargin_px,
                     even(image.cols) - image.cols + kMargin_px, border_type, cv::Scalar::all(0));
  return out;
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

std::optional<ScaledView> scale_view(const TrainingView& view, double distance, double focal_px) {
  const Eigen::Vector3d origin = view.T_camera_object.translation();
  const double zoom = focal_px > 0.0 ? focal_px / view.frame.camera.fx : 1.0;
  const double scale = zoom * origin.z() / distance;
  const cv::Rect part = surroundings(view, scale);
  if (part.empty()) return std::nullopt;
  const cv::Size size(std::max(1, static_cast<int>(std::lround(part.width * scale))),
                      std::max(1, static_cast<int>(std::lround(part.height * scale))));
  cv::Mat colour;
  cv::Mat depth;
  cv::Mat mask;
  cv::resize(view.frame.colour(part), colour, size, 0, 0, scale < 1 ? cv::INTER_AREA : cv::INTER_LINEAR);
  cv::resize(view.frame.depth(part), depth, size, 0, 0, cv::INTER_NEAREST);
  cv::resize(view.mask(part), mask, size, 0, 0, cv::INTER_NEAREST);

  ScaledView out;
  out.distance = distance;
  out.view_scale = scale;
  out.colour = with_margin(colour, cv::BORDER_REPLICATE);
  out.mask = with_margin(mask, cv::BORDER_CONSTANT);
  cv::Mat depth_mm = depth_to_millimetres(depth + (distance - origin.z()));
  depth_mm.setTo(0, mask == 0);
  out.depth_mm = with_margin(depth_mm, cv::BORDER_CONSTANT);
  if (cv::countNonZero(out.depth_mm) == 0) return std::nullopt;
  const Eigen::Vector2d origin_px = view.frame.camera.project(origin);
  out.origin_px = {(origin_px.x() - part.x) * scale + kMargin_px, (origin_px.y() - part.y) * scale + kMargin_px};
  return out;
}

}  // namespace houghstream
