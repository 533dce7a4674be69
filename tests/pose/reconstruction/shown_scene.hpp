#pragma once

#include <cmath>
#include <limits>
#include <opencv2/core.hpp>

#include "pipeline/base/random.hpp"
#include "pipeline/geometry/mesh.hpp"
#include "pipeline/geometry/renderer.hpp"
#include "pipeline/types/frame.hpp"

namespace houghstream::test_scene {

/// Describes a box on a table, both painted with spots; z up, the table at 0. It is rendered without noise.
struct ShownScene {
  Eigen::Vector3d box = {0.12, 0.08, 0.16};  ///< sides, metres; 0 = no box
  Eigen::Vector3d disc = {0.0, 0.0, 0.0};    ///< sides of a slab under the box; 0 = none
  Camera camera = {320, 240, 290.0, 290.0, 159.5, 119.5};
};

/// Adds a rectangle from `corner` along two sides, in small squares with colours of their own.
inline void add_side(const Eigen::Vector3d& corner, const Eigen::Vector3d& u, const Eigen::Vector3d& v, Mesh& mesh) {
  constexpr double kSquare_m = 0.012;
  const int nu = std::max(2, static_cast<int>(u.norm() / kSquare_m));
  const int nv = std::max(2, static_cast<int>(v.norm() / kSquare_m));
  Random random(static_cast<std::uint64_t>(1e4 * (corner.norm() + 3.0 * u.x() + 5.0 * v.z() + 7.0 * v.y())) + 11);
  for (int i = 0; i < nu; ++i) {
    for (int j = 0; j < nv; ++j) {
      const auto shade = static_cast<std::uint8_t>(60 + random.below(160));
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      for (const auto& [a, b] : {std::pair{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}}) {
        mesh.vertices.push_back((corner + u * a / nu + v * b / nv).cast<float>());
        mesh.colours.emplace_back(shade, static_cast<std::uint8_t>(255 - shade), shade);
      }
      mesh.triangles.push_back({first, first + 1, first + 2});
      mesh.triangles.push_back({first, first + 2, first + 3});
    }
  }
}

inline void add_box(const Eigen::Vector3d& size, double bottom, Mesh& mesh) {
  const Eigen::Vector3d x(size.x(), 0.0, 0.0), y(0.0, size.y(), 0.0), z(0.0, 0.0, size.z());
  const Eigen::Vector3d low(-0.5 * size.x(), -0.5 * size.y(), bottom);
  add_side(low, x, z, mesh);
  add_side(low + x, y, z, mesh);
  add_side(low + x + y, -x, z, mesh);
  add_side(low + y, -y, z, mesh);
  add_side(low + z, x, y, mesh);
}

inline Mesh table_with(const ShownScene& scene) {
  Mesh mesh;
  add_side({-0.6, -0.6, 0.0}, {1.2, 0.0, 0.0}, {0.0, 1.2, 0.0}, mesh);
  if (scene.disc.z() > 0.0) add_box(scene.disc, 0.0, mesh);
  if (scene.box.z() > 0.0) add_box(scene.box, scene.disc.z(), mesh);
  return mesh;
}

/// Returns the scene's box by itself, where it stands.
inline Mesh box_of(const ShownScene& scene) {
  Mesh mesh;
  add_box(scene.box, scene.disc.z(), mesh);
  return mesh;
}

/// Returns the camera at an azimuth and elevation, radians, looking at a point above the origin.
inline Eigen::Isometry3d camera_at(double azimuth, double elevation, double distance) {
  const Eigen::Vector3d eye(distance * std::cos(elevation) * std::cos(azimuth),
                            distance * std::cos(elevation) * std::sin(azimuth), 0.07 + distance * std::sin(elevation));
  const Eigen::Vector3d forward = (Eigen::Vector3d(0.0, 0.0, 0.07) - eye).normalized();
  const Eigen::Vector3d right = forward.cross(Eigen::Vector3d::UnitZ()).normalized();
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear().row(0) = right;
  T.linear().row(1) = forward.cross(right);
  T.linear().row(2) = forward;
  T.translation() = -T.linear() * eye;
  return T;
}

inline RgbdFrame photograph(const Mesh& mesh, const Eigen::Isometry3d& T_camera_world, const Camera& camera,
                            std::int64_t utime) {
  const RenderedGeometry rendered = render_geometry({{&mesh, T_camera_world, 1}}, camera);
  RgbdFrame frame;
  frame.id.utime = utime;
  frame.camera = camera;
  frame.depth = rendered.depth;
  frame.colour = cv::Mat(camera.height, camera.width, CV_8UC3, cv::Scalar(90, 90, 90));
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const int triangle = rendered.triangle.at<std::int32_t>(y, x);
      if (triangle >= 0)
        frame.colour.at<cv::Vec3b>(y, x) = mesh.colours[mesh.triangles[static_cast<std::size_t>(triangle)][0]];
    }
  }
  return frame;
}

}  // namespace houghstream::test_scene
