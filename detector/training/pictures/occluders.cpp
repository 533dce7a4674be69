#include "detector/training/pictures/occluders.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

namespace houghstream::training {
namespace {

constexpr double kBaselineM = 0.075;  // projector to camera, PrimeSense and Kinect

/// A turned rectangle or ellipse around a point of the object's outline box.
cv::Mat random_shape(const cv::Rect& object_px, cv::Size size, Random& random) {
  const double side = std::sqrt(static_cast<double>(object_px.area()));
  const cv::Point2f centre(static_cast<float>(object_px.x + random.uniform(-0.3, 1.3) * object_px.width),
                           static_cast<float>(object_px.y + random.uniform(0.0, 1.4) * object_px.height));
  const cv::RotatedRect shape(centre,
                              cv::Size2f(static_cast<float>(side * random.uniform(0.4, 1.6)),
                                         static_cast<float>(side * random.uniform(0.4, 1.6))),
                              static_cast<float>(random.uniform() < 0.6 ? 0.0 : random.uniform(-90.0, 90.0)));
  cv::Mat mask = cv::Mat::zeros(size, CV_8UC1);
  if (random.uniform() < 0.5) {
    cv::ellipse(mask, shape, cv::Scalar(255), cv::FILLED);
  } else {
    std::array<cv::Point2f, 4> corners;
    shape.points(corners.data());
    std::vector<cv::Point> polygon(corners.begin(), corners.end());
    cv::fillConvexPoly(mask, polygon, cv::Scalar(255));
  }
  return mask;
}

/// Depth is lost where the occluder hides the projector, to the right of the camera: to the left of each occluded run.
void cast_shadow(const cv::Mat& occluder, double occluder_depth, RgbdFrame& frame) {
  for (int y = 0; y < occluder.rows; ++y) {
    auto* depth = frame.depth.ptr<float>(y);
    const auto* hides = occluder.ptr<std::uint8_t>(y);
    for (int x = 1; x < occluder.cols; ++x) {
      if (hides[x] == 0 || hides[x - 1] != 0) continue;
      for (int s = x - 1; s >= 0; --s) {
        const double width = frame.camera.fx * kBaselineM * (1.0 / occluder_depth - 1.0 / depth[s]);
        if (std::isfinite(depth[s]) && width < x - s) break;
        depth[s] = std::numeric_limits<float>::quiet_NaN();
        if (x - s > 40) break;
      }
    }
  }
}

}  // namespace

void add_occluder(const RgbdFrame& room, double object_distance, Composite& composite, Random& random) {
  constexpr int kTries = 8;
  const cv::Rect object_px = cv::boundingRect(composite.mask);
  const int whole = cv::countNonZero(composite.mask);
  cv::Mat shape;
  for (int i = 0; i < kTries; ++i) {
    shape = random_shape(object_px, composite.mask.size(), random);
    const int left = whole - cv::countNonZero(shape & composite.mask);
    if (left <= 0.9 * whole && left >= 0.2 * whole) break;
    shape.release();
  }
  if (shape.empty()) return;

  const cv::Point from(random.between(0, room.colour.cols - shape.cols),
                       random.between(0, room.colour.rows - shape.rows));
  const double depth = std::max(0.3, object_distance - random.uniform(0.04, 0.35));
  const double slope_x = random.uniform(-0.5, 0.5) * depth / composite.frame.camera.fx;
  const double sigma = axial_noise(depth);
  cast_shadow(shape, depth, composite.frame);
  composite.occluder = shape;
  for (int y = 0; y < shape.rows; ++y) {
    for (int x = 0; x < shape.cols; ++x) {
      if (shape.at<std::uint8_t>(y, x) == 0) continue;
      composite.frame.colour.at<cv::Vec3b>(y, x) = room.colour.at<cv::Vec3b>(from.y + y, from.x + x);
      composite.frame.depth.at<float>(y, x) =
          static_cast<float>(depth + slope_x * (x - object_px.x) + sigma * random.normal());
      composite.mask.at<std::uint8_t>(y, x) = 0;
    }
  }
}

}  // namespace houghstream::training
