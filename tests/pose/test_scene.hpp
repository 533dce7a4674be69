#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "pipeline/base/random.hpp"
#include "pipeline/geometry/renderer.hpp"
#include "pipeline/types/detection.hpp"
#include "pipeline/types/frame.hpp"

// Objects and noisy frames with a known truth for the tests of the pose library.

namespace houghstream::test_scene {

inline const Camera kCamera{640, 480, 525.0, 525.0, 319.5, 239.5};

inline void add_quad(Mesh& mesh, const std::array<Eigen::Vector3f, 4>& corners) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), corners.begin(), corners.end());
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

/// Axis-aligned box, corners counter-clockwise seen from outside.
inline void add_box(Mesh& mesh, const Eigen::Vector3f& low, const Eigen::Vector3f& high) {
  const auto at = [&](int x, int y, int z) {
    return Eigen::Vector3f(x == 0 ? low.x() : high.x(), y == 0 ? low.y() : high.y(), z == 0 ? low.z() : high.z());
  };
  add_quad(mesh, {at(0, 0, 0), at(0, 1, 0), at(1, 1, 0), at(1, 0, 0)});
  add_quad(mesh, {at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1)});
  add_quad(mesh, {at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1)});
  add_quad(mesh, {at(0, 1, 0), at(0, 1, 1), at(1, 1, 1), at(1, 1, 0)});
  add_quad(mesh, {at(0, 0, 0), at(0, 0, 1), at(0, 1, 1), at(0, 1, 0)});
  add_quad(mesh, {at(1, 0, 0), at(1, 1, 0), at(1, 1, 1), at(1, 0, 1)});
}

inline Mesh cereal_box() {
  Mesh mesh;
  add_box(mesh, {-0.09F, -0.03F, -0.13F}, {0.09F, 0.03F, 0.13F});
  return mesh;
}

/// Returns a thin-walled cup, open at the top (+z), with a square handle towards +x.
inline Mesh mug() {
  Mesh mesh;
  constexpr int kSides = 48;
  constexpr float kOuter = 0.042F;
  constexpr float kInner = 0.038F;
  constexpr float kHalf = 0.05F;
  const auto ring = [](float radius, int i, float z) {
    const float angle = 6.2831853F * static_cast<float>(i) / kSides;
    return Eigen::Vector3f(radius * std::cos(angle), radius * std::sin(angle), z);
  };
  for (int i = 0; i < kSides; ++i) {
    const int j = i + 1;
    add_quad(mesh, {ring(kOuter, i, -kHalf), ring(kOuter, j, -kHalf), ring(kOuter, j, kHalf), ring(kOuter, i, kHalf)});
    add_quad(mesh, {ring(kInner, j, -kHalf + 0.004F), ring(kInner, i, -kHalf + 0.004F), ring(kInner, i, kHalf),
                    ring(kInner, j, kHalf)});
    add_quad(mesh, {ring(kOuter, i, kHalf), ring(kOuter, j, kHalf), ring(kInner, j, kHalf), ring(kInner, i, kHalf)});
    add_quad(mesh, {ring(kOuter, j, -kHalf), ring(kOuter, i, -kHalf), ring(0.0F, i, -kHalf), ring(0.0F, j, -kHalf)});
    add_quad(mesh, {ring(kInner, i, -kHalf + 0.004F), ring(kInner, j, -kHalf + 0.004F), ring(0.0F, j, -kHalf + 0.004F),
                    ring(0.0F, i, -kHalf + 0.004F)});
  }
  add_box(mesh, {0.040F, -0.006F, 0.02F}, {0.07F, 0.006F, 0.032F});
  add_box(mesh, {0.040F, -0.006F, -0.032F}, {0.07F, 0.006F, -0.02F});
  add_box(mesh, {0.060F, -0.006F, -0.02F}, {0.07F, 0.006F, 0.02F});
  return mesh;
}

/// Returns a horizontal table, 4 m wide, its top at z = 0 of its own frame.
inline Mesh table() {
  Mesh mesh;
  add_quad(mesh, {Eigen::Vector3f(-2, -2, 0), Eigen::Vector3f(2, -2, 0), Eigen::Vector3f(2, 2, 0),
                  Eigen::Vector3f(-2, 2, 0)});
  return mesh;
}

/// Returns the camera looking down at `pitch_deg` on an object that stands `distance_m` away, turned by `azimuth_deg`
/// about its z.
inline Eigen::Isometry3d standing(double azimuth_deg, double pitch_deg, double distance_m) {
  constexpr double kRad = 0.017453292519943295;
  Eigen::Isometry3d T_camera_object = Eigen::Isometry3d::Identity();
  T_camera_object.translate(Eigen::Vector3d(0.03, 0.02, distance_m));
  T_camera_object.rotate(Eigen::AngleAxisd((90.0 + pitch_deg) * kRad, Eigen::Vector3d::UnitX()));
  T_camera_object.rotate(Eigen::AngleAxisd(azimuth_deg * kRad, Eigen::Vector3d::UnitZ()));
  return T_camera_object;
}

/// Returns the depth of the items with noise growing as z^2 (1.4 mm at 1 m) and 2 % of the pixels lost.
inline RgbdFrame noisy_frame(const std::vector<RenderItem>& items, std::uint64_t seed) {
  RgbdFrame frame;
  frame.id.utime = 1000;
  frame.camera = kCamera;
  frame.colour = cv::Mat(kCamera.height, kCamera.width, CV_8UC3, cv::Scalar(90, 90, 90));
  const RenderedGeometry rendered = render_geometry(items, kCamera);
  frame.depth = rendered.depth;
  frame.colour.setTo(cv::Scalar(110, 140, 160), rendered.id == 1);
  Random random(seed);
  for (int y = 0; y < frame.depth.rows; ++y) {
    for (int x = 0; x < frame.depth.cols; ++x) {
      float& z = frame.depth.at<float>(y, x);
      z += static_cast<float>(0.00143 * random.normal()) * z * z;
      if (random.uniform() < 0.02) z = std::numeric_limits<float>::quiet_NaN();
    }
  }
  return frame;
}

/// Returns the true pose rotated by `degrees` about a random axis and moved by `metres` in a random direction.
inline Eigen::Isometry3d perturbed(const Eigen::Isometry3d& T_camera_object, double degrees, double metres,
                                   Random& random) {
  const auto direction = [&random] {
    return Eigen::Vector3d(random.normal(), random.normal(), random.normal()).normalized();
  };
  Eigen::Isometry3d out = T_camera_object;
  out.rotate(Eigen::AngleAxisd(degrees * 0.017453292519943295, direction()));
  out.pretranslate(metres * direction());
  return out;
}

/// ADD-S (Hinterstoisser et al. 2012): mean distance from each point under the true pose to the nearest one under the
/// estimate, less what the sampling of the surface adds, metres.
class SurfaceError {
 public:
  explicit SurfaceError(const Mesh& mesh)
      : some_(sample_surface(mesh, 300, 1).points),
        many_(sample_surface(mesh, 1000, 2).points),
        of_truth_(mean_distance(Eigen::Isometry3d::Identity())) {}

  double operator()(const Eigen::Isometry3d& truth, const Eigen::Isometry3d& estimate) const {
    return mean_distance(estimate.inverse() * truth) - of_truth_;
  }

 private:
  double mean_distance(const Eigen::Isometry3d& motion) const {
    double sum = 0.0;
    for (const Eigen::Vector3f& p : some_) {
      const Eigen::Vector3f here = motion.cast<float>() * p;
      float best_sq = 1e9F;
      for (const Eigen::Vector3f& q : many_) best_sq = std::min(best_sq, (q - here).squaredNorm());
      sum += std::sqrt(best_sq);
    }
    return sum / static_cast<double>(some_.size());
  }

  std::vector<Eigen::Vector3f> some_;
  std::vector<Eigen::Vector3f> many_;
  double of_truth_;
};

/// A detection as the detector gives it: box about the true silhouette, centre off by 15 mm, half the votes about the
/// truth (15 degrees), half anywhere.
inline Detection detection_of(const std::string& name, const Mesh& mesh, const Eigen::Isometry3d& truth,
                              std::uint64_t seed) {
  Random random(seed);
  Detection detection;
  detection.class_id = 1;
  detection.class_name = name;
  detection.score = 0.9F;
  cv::Rect2f box;
  for (const Eigen::Vector3f& v : mesh.vertices) {
    const Eigen::Vector2d pixel = kCamera.project(truth * v.cast<double>());
    const cv::Rect2f spot(static_cast<float>(pixel.x()), static_cast<float>(pixel.y()), 1.0F, 1.0F);
    box = box.area() > 0.0F ? box | spot : spot;
  }
  detection.box_px = box;
  detection.centre_camera = perturbed(truth, 0.0, 0.015, random).translation().cast<float>();
  for (int i = 0; i < 24; ++i) {
    const Eigen::Isometry3d T = perturbed(truth, i % 2 == 0 ? 15.0 : 180.0 * random.uniform(), 0.0, random);
    detection.rotations.push_back({Eigen::Quaternionf(T.linear().cast<float>()), 1.0F});
  }
  return detection;
}

}  // namespace houghstream::test_scene
