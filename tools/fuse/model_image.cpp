#include "tools/fuse/model_image.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "pipeline/geometry/renderer.hpp"

namespace houghstream {
namespace {

constexpr int kSize_px = 320;

/// Returns the camera that looks at `centre` from `azimuth` and `elevation` (radians).
Eigen::Isometry3d looking_at(const Eigen::Vector3d& centre, double azimuth, double elevation, double distance) {
  const Eigen::Vector3d forward(-std::cos(elevation) * std::cos(azimuth), -std::cos(elevation) * std::sin(azimuth),
                                -std::sin(elevation));
  const Eigen::Vector3d right(-std::sin(azimuth), std::cos(azimuth), 0.0);
  Eigen::Isometry3d T_camera_object = Eigen::Isometry3d::Identity();
  T_camera_object.linear().row(0) = right;
  T_camera_object.linear().row(1) = forward.cross(right);
  T_camera_object.linear().row(2) = forward;
  T_camera_object.translation() = Eigen::Vector3d(0.0, 0.0, distance) - T_camera_object.linear() * centre;
  return T_camera_object;
}

/// Values at the three corners of a visible triangle.
Eigen::Vector3d mixed(const cv::Vec2f& bary, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                      const Eigen::Vector3d& c) {
  return (1.0 - bary[0] - bary[1]) * a + static_cast<double>(bary[0]) * b + static_cast<double>(bary[1]) * c;
}

Eigen::Vector3d colour_of(const Mesh& mesh, std::uint32_t vertex) {
  if (mesh.colours.size() != mesh.vertices.size()) return Eigen::Vector3d::Constant(200.0);
  const cv::Vec3b& c = mesh.colours[vertex];
  return {static_cast<double>(c[0]), static_cast<double>(c[1]), static_cast<double>(c[2])};
}

/// Draws a view in colours above, as shape below.
cv::Mat draw_view(const Mesh& mesh, const Eigen::Isometry3d& T_camera_object, const Camera& camera) {
  const RenderedGeometry rendered = render_geometry({{&mesh, T_camera_object, 1}}, camera);
  cv::Mat image(2 * kSize_px, kSize_px, CV_8UC3, cv::Scalar::all(255));
  for (int y = 0; y < kSize_px; ++y) {
    for (int x = 0; x < kSize_px; ++x) {
      const int triangle = rendered.triangle.at<std::int32_t>(y, x);
      if (triangle < 0) continue;
      const auto& [a, b, c] = mesh.triangles[static_cast<std::size_t>(triangle)];
      const cv::Vec2f bary = rendered.bary.at<cv::Vec2f>(y, x);
      const Eigen::Vector3d colour = mixed(bary, colour_of(mesh, a), colour_of(mesh, b), colour_of(mesh, c));
      const Eigen::Vector3d normal =
          mixed(bary, mesh.normals[a].cast<double>(), mesh.normals[b].cast<double>(), mesh.normals[c].cast<double>());
      // Light comes from above the camera's left shoulder; a surface that faces away from it is dark, so turned
      // triangles show.
      const Eigen::Vector3d light = Eigen::Vector3d(-0.3, -0.4, -1.0).normalized();
      const double lit = std::max(0.0, (T_camera_object.linear() * normal).normalized().dot(light));
      image.at<cv::Vec3b>(y, x) =
          cv::Vec3b(cv::saturate_cast<std::uint8_t>(colour[0]), cv::saturate_cast<std::uint8_t>(colour[1]),
                    cv::saturate_cast<std::uint8_t>(colour[2]));
      image.at<cv::Vec3b>(y + kSize_px, x) = cv::Vec3b::all(cv::saturate_cast<std::uint8_t>(20.0 + 220.0 * lit));
    }
  }
  return image;
}

}  // namespace

cv::Mat draw_model(const Mesh& mesh) {
  const double diameter = mesh_diameter(mesh);
  const Eigen::Vector3d centre = mesh_bounds(mesh).center().cast<double>();
  const double distance = 5.0 * diameter;
  const double focal = 0.95 * kSize_px * distance / diameter;
  const double middle = 0.5 * (kSize_px - 1);
  const Camera camera{kSize_px, kSize_px, focal, focal, middle, middle};
  constexpr double kSide = 25.0 * M_PI / 180.0;
  std::vector<cv::Mat> views;
  views.reserve(6);  // views from four sides, above and below
  for (int k = 0; k < 4; ++k) {
    views.push_back(draw_view(mesh, looking_at(centre, k * M_PI_2 - M_PI_2, kSide, distance), camera));
  }
  for (const double elevation : {M_PI_2, -M_PI_2}) {
    views.push_back(draw_view(mesh, looking_at(centre, -M_PI_2, elevation, distance), camera));
  }
  cv::Mat image;
  cv::hconcat(views, image);
  return image;
}

}  // namespace houghstream
