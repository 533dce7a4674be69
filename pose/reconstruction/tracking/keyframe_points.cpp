#include "pose/reconstruction/tracking/keyframe_points.hpp"

#include <cmath>
#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace houghstream::reconstruction {
namespace {

/// Removes from a keyframe's mask the points that violate the free space of the map's keyframes: a hand.
void remove_free_space_violations(const Keyframe& keyframe, const KeyframeMap& map, cv::Mat& mask) {
  constexpr double kBehind_m = 0.015;
  constexpr double kMaxViewAngle = 1.2;  // radians: keyframes from farther round do not see this side
  const FrameLevel& level = keyframe.levels.levels[0];
  const Eigen::Isometry3d T_world_camera = keyframe.T_camera_world.inverse();
  for (const Keyframe& other : map.keyframes()) {
    if (map.view_angle(other.T_camera_world, keyframe.T_camera_world) > kMaxViewAngle) continue;
    const Eigen::Isometry3d T = other.T_camera_world * T_world_camera;
    for (int y = 0; y < mask.rows; ++y) {
      for (int x = 0; x < mask.cols; ++x) {
        if (mask.at<std::uint8_t>(y, x) == 0) continue;
        const Eigen::Vector3d p = T * level.camera.backproject(x, y, level.depth.at<float>(y, x));
        if (p.z() < 0.1) continue;
        const Eigen::Vector2d px = other.frame.camera.project(p);
        const cv::Point at(cvRound(px.x()), cvRound(px.y()));
        if (!cv::Rect({0, 0}, other.frame.depth.size()).contains(at)) continue;
        const float z = other.frame.depth.at<float>(at);
        if (z > p.z() + kBehind_m + 3.0 * depth_sigma(z)) mask.at<std::uint8_t>(y, x) = 0;
      }
    }
  }
  cv::erode(mask, mask, cv::getStructuringElement(cv::MORPH_RECT, {3, 3}));
}

/// Takes out of a mask what has the colour of skin, with what is around. `colour` shows the same region, possibly at
/// another size.
void remove_skin(const cv::Mat& colour, cv::Mat& mask) {
  cv::Mat skin;
  cv::dilate(skin_pixels(colour), skin, cv::getStructuringElement(cv::MORPH_ELLIPSE, {7, 7}));
  cv::resize(skin, skin, mask.size(), 0, 0, cv::INTER_NEAREST);
  mask.setTo(0, skin);
}

}  // namespace

cv::Mat object_pixels(const FrameLevel& level, const SelectedObject& object, const Eigen::Isometry3d& T_camera_world) {
  constexpr double kMin_m = 0.006;
  const double widest = 1.3 * object.radius_m + 0.01;
  const Eigen::Isometry3d T_world_camera = T_camera_world.inverse();
  cv::Mat mask = cv::Mat::zeros(level.depth.size(), CV_8UC1);
  for (int y = 0; y < mask.rows; ++y) {
    for (int x = 0; x < mask.cols; ++x) {
      const float z = level.depth.at<float>(y, x);
      if (!(z > 0.1F)) continue;
      const Eigen::Vector3d p = T_world_camera * level.camera.backproject(x, y, z);
      const bool is_on_object = p.z() > kMin_m && p.z() < object.height_m + 0.03 && std::hypot(p.x(), p.y()) < widest;
      mask.at<std::uint8_t>(y, x) = is_on_object ? 255 : 0;
    }
  }
  return mask;
}

LevelPoints points_of_scene(const Keyframe& keyframe) {
  constexpr double kTableRadius_m = 0.7;
  constexpr float kTableHeight_m = 0.01F;
  LevelPoints points = choose_points(keyframe.levels, {}, {});
  const Eigen::Isometry3f T_world_camera = keyframe.T_camera_world.inverse().cast<float>();
  for (std::vector<SurfacePoint>& level : points) {
    for (SurfacePoint& point : level) {
      const Eigen::Vector3f p = T_world_camera * point.point;
      point.on_table = std::abs(p.z()) < kTableHeight_m && p.head<2>().norm() < kTableRadius_m &&
                       (T_world_camera.linear() * point.normal).z() > 0.95F;
    }
  }
  return points;
}

LevelPoints points_of_object(const Keyframe& keyframe, const KeyframeMap& map, const SelectedObject& object,
                             const cv::Rect& region_px) {
  cv::Mat mask = object_pixels(keyframe.levels.levels[0], object, keyframe.T_camera_world);
  remove_free_space_violations(keyframe, map, mask);
  if (!object.is_skin_coloured) remove_skin(keyframe.frame.colour(region_px), mask);
  PointSettings points;
  points.cell_px = 4;
  return choose_points(keyframe.levels, mask, points);
}

}  // namespace houghstream::reconstruction
