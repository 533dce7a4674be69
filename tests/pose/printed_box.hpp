#pragma once

#include <opencv2/imgproc.hpp>

#include "tests/pose/test_scene.hpp"

namespace houghstream::test_scene {

/// Returns the cereal box with a colour of its own on each side; of the two large ones (+-y) one has a red and one a
/// blue half.
inline Mesh printed_box() {
  Mesh mesh = cereal_box();
  const std::array<cv::Vec3b, 6> sides = {cv::Vec3b(90, 90, 90),  cv::Vec3b(200, 200, 200), cv::Vec3b(40, 40, 220),
                                          cv::Vec3b(220, 60, 40), cv::Vec3b(60, 200, 60),   cv::Vec3b(60, 200, 220)};
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    cv::Vec3b colour = sides.at(v / 4);
    if (mesh.vertices[v].z() > 0.0F) colour = cv::Vec3b(colour[2], colour[1], colour[0]);
    mesh.colours.push_back(colour);
  }
  return mesh;
}

/// Depth as noisy_frame gives it, and the mesh's vertex colours under a light from above the camera.
inline RgbdFrame coloured_frame(const Mesh& mesh, const Eigen::Isometry3d& T_camera_object, std::uint64_t seed) {
  RgbdFrame frame = noisy_frame({{&mesh, T_camera_object, 1}}, seed);
  const RenderedGeometry rendered = render_geometry({{&mesh, T_camera_object, 1}}, kCamera);
  for (int y = 0; y < frame.colour.rows; ++y) {
    for (int x = 0; x < frame.colour.cols; ++x) {
      const int triangle = rendered.triangle.at<std::int32_t>(y, x);
      if (triangle < 0) continue;
      const auto& [a, b, c] = mesh.triangles[static_cast<std::size_t>(triangle)];
      const auto& bary = rendered.bary.at<cv::Vec2f>(y, x);
      const Eigen::Vector3f normal =
          T_camera_object.linear().cast<float>() *
          (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).normalized();
      const float light = 0.5F + 0.3F * std::abs(normal.z()) - 0.15F * normal.y();
      frame.colour.at<cv::Vec3b>(y, x) =
          light * ((1.0F - bary[0] - bary[1]) * cv::Vec3f(mesh.colours[a]) + bary[0] * cv::Vec3f(mesh.colours[b]) +
                   bary[1] * cv::Vec3f(mesh.colours[c]));
    }
  }
  return frame;
}

/// Returns the pose rotated about the object's z axis.
inline Eigen::Isometry3d rotated(const Eigen::Isometry3d& T_camera_object, double degrees) {
  Eigen::Isometry3d out = T_camera_object;
  out.rotate(Eigen::AngleAxisd(degrees * 0.017453292519943295, Eigen::Vector3d::UnitZ()));
  return out;
}

inline double degrees_between(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  constexpr double kDegrees = 57.29577951308232;
  return kDegrees * Eigen::Quaterniond(a.linear()).angularDistance(Eigen::Quaterniond(b.linear()));
}

}  // namespace houghstream::test_scene
