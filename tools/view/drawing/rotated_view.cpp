#include "tools/view/drawing/rotated_view.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace houghstream::view {
namespace {

constexpr double kFromTheRight = 35.0 * M_PI / 180.0;
constexpr double kFromAbove = 25.0 * M_PI / 180.0;
const cv::Scalar kTurnedGround(40, 34, 30);

/// Returns the median of the measured depths, from a part of them; 1 m where there are none.
double middle_depth(const cv::Mat& depth) {
  constexpr int kStep = 8;
  std::vector<float> measured;
  for (int y = 0; y < depth.rows; y += kStep) {
    for (int x = 0; x < depth.cols; x += kStep) {
      if (const float z = depth.at<float>(y, x); std::isfinite(z)) measured.push_back(z);
    }
  }
  if (measured.empty()) return 1.0;
  const auto middle = measured.begin() + static_cast<std::ptrdiff_t>(measured.size() / 2);
  std::nth_element(measured.begin(), middle, measured.end());
  return static_cast<double>(*middle);
}

/// Draws an image of points, of which the nearest one is visible.
class PointImage {
 public:
  explicit PointImage(const Camera& camera)
      : camera_(camera),
        image_(camera.height, camera.width, CV_8UC3, kTurnedGround),
        nearest_(camera.height, camera.width, CV_32FC1, cv::Scalar(std::numeric_limits<float>::infinity())) {}

  void add(const Eigen::Vector3f& point, const cv::Vec3b& colour) {
    if (point.z() < kNearPlane) return;
    const Eigen::Vector2f pixel = camera_.project_single(point);
    const auto reach = static_cast<float>(std::max(camera_.width, camera_.height));
    if (!(pixel.cwiseAbs().maxCoeff() < reach)) return;
    const int left = static_cast<int>(std::floor(pixel.x()));
    const int top = static_cast<int>(std::floor(pixel.y()));
    // Each point covers four pixels, so that points that drift apart leave no gaps yet.
    for (int y = std::max(top, 0); y < std::min(top + 2, image_.rows); ++y) {
      for (int x = std::max(left, 0); x < std::min(left + 2, image_.cols); ++x) {
        if (nearest_.at<float>(y, x) <= point.z()) continue;
        nearest_.at<float>(y, x) = point.z();
        image_.at<cv::Vec3b>(y, x) = colour;
      }
    }
  }

  const cv::Mat& image() const { return image_; }

 private:
  Camera camera_;
  cv::Mat image_;
  cv::Mat nearest_;
};

}  // namespace

Eigen::Isometry3d rotated_camera(const cv::Mat& depth) {
  const Eigen::Translation3d pivot(0.0, 0.0, middle_depth(depth));
  return Eigen::Isometry3d(pivot * Eigen::AngleAxisd(kFromAbove, Eigen::Vector3d::UnitX()) *
                           Eigen::AngleAxisd(kFromTheRight, Eigen::Vector3d::UnitY()) * pivot.inverse());
}

cv::Mat draw_rotated_view(const RgbdFrame& frame, const std::optional<ObjectPoses>& poses, const ClassModels& models) {
  const Eigen::Isometry3d T_rotated_camera = rotated_camera(frame.depth);
  const Eigen::Isometry3f T = T_rotated_camera.cast<float>();
  PointImage point_image(frame.camera);
  for (int y = 0; y < frame.depth.rows; ++y) {
    for (int x = 0; x < frame.depth.cols; ++x) {
      const float z = frame.depth.at<float>(y, x);
      if (!std::isfinite(z)) continue;
      point_image.add(T * frame.camera.backproject(x, y, z).cast<float>(), frame.colour.at<cv::Vec3b>(y, x));
    }
  }
  cv::Mat image = point_image.image();
  if (!poses) return image;
  for (ObjectPose pose : poses->poses) {
    if (pose.T_camera_object) pose.T_camera_object = T_rotated_camera * *pose.T_camera_object;
    draw_pose(image, pose, models, frame.camera);
  }
  return image;
}

}  // namespace houghstream::view
