#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "pipeline/base/random.hpp"
#include "pipeline/geometry/renderer.hpp"
#include "pipeline/types/training_view.hpp"
#include "tests/pose/test_scene.hpp"

// Views of a turning object with a known shape, for the tests of fusion.

namespace houghstream::test_scene {

/// An albedo returns BGR of a surface point, object frame.
using Albedo = std::function<cv::Vec3b(const Eigen::Vector3d&)>;

struct TurntableScene {
  Mesh mesh;
  Albedo paint = [](const Eigen::Vector3d&) { return cv::Vec3b(90, 120, 150); };
  int views = 24;
  double elevation = 0.5;  ///< radians
  double noise_m = 0.0;    ///< standard deviation of depth; it is rounded to millimetres where there is noise
  bool background = true;  ///< depth of a wall beside the object; false: no depth there
};

/// Returns the pose on a turntable: object frame z up, the camera 0.6 m away.
inline Eigen::Isometry3d turntable_pose(double azimuth, double elevation) {
  Eigen::Isometry3d T_camera_object = Eigen::Isometry3d::Identity();
  T_camera_object.linear() = (Eigen::AngleAxisd(M_PI_2 + elevation, Eigen::Vector3d::UnitX()) *
                              Eigen::AngleAxisd(azimuth, Eigen::Vector3d::UnitZ()))
                                 .toRotationMatrix();
  T_camera_object.translation() = Eigen::Vector3d(0.01, -0.02, 0.6);
  return T_camera_object;
}

inline TrainingView turntable_view(const TurntableScene& scene, int index) {
  constexpr double kWall_m = 1.2;
  TrainingView view;
  view.class_id = 1;
  view.class_name = "toy";
  view.source = "view " + std::to_string(index);
  view.T_camera_object = turntable_pose(2.0 * M_PI * index / scene.views, scene.elevation);
  view.frame.camera = kCamera.cropped(200, 80, 260, 280);
  const RenderedGeometry rendered = render_geometry({{&scene.mesh, view.T_camera_object, 1}}, view.frame.camera);
  view.frame.depth = rendered.depth.clone();
  view.frame.colour = cv::Mat(rendered.depth.size(), CV_8UC3, cv::Scalar(10, 10, 10));
  view.mask = rendered.id > 0;
  Random random = Random::for_item(1, static_cast<std::uint64_t>(index));
  for (int y = 0; y < rendered.depth.rows; ++y) {
    for (int x = 0; x < rendered.depth.cols; ++x) {
      float& z = view.frame.depth.at<float>(y, x);
      if (view.mask.at<std::uint8_t>(y, x) == 0) {
        z = scene.background ? static_cast<float>(kWall_m) : std::numeric_limits<float>::quiet_NaN();
        continue;
      }
      view.frame.colour.at<cv::Vec3b>(y, x) =
          scene.paint(view.T_camera_object.inverse() * view.frame.camera.backproject(x, y, z));
      z += static_cast<float>(scene.noise_m * random.normal());
    }
  }
  if (scene.noise_m > 0.0) view.frame.depth = depth_from_millimetres(depth_to_millimetres(view.frame.depth));
  return view;
}

inline std::vector<TrainingView> turntable_views(const TurntableScene& scene) {
  std::vector<TrainingView> views;
  views.reserve(static_cast<std::size_t>(scene.views));
  for (int i = 0; i < scene.views; ++i) views.push_back(turntable_view(scene, i));
  return views;
}

/// Returns a signed distance, positive outside the box; `half` is half its size, metres.
inline double box_distance(const Eigen::Vector3d& point, const Eigen::Vector3d& half) {
  const Eigen::Vector3d past = point.cwiseAbs() - half;
  return past.cwiseMax(0.0).norm() + std::min(0.0, past.maxCoeff());
}

inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? std::numeric_limits<double>::quiet_NaN() : values[values.size() / 2];
}

}  // namespace houghstream::test_scene
