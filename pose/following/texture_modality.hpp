#pragma once

#include <Eigen/Geometry>
#include <array>
#include <opencv2/core.hpp>
#include <vector>

#include "pipeline/base/settings_fields.hpp"
#include "pose/following/region_modality.hpp"
#include "pose/registration/depth_equations.hpp"

namespace houghstream {

/// Texture modality: an object's surface keeps the brightness that it had in an earlier frame. Direct alignment as
/// Engel, Koltun and Cremers (2018, "Direct Sparse Odometry") have it, of points of the surface instead of a scene.
struct TextureModalitySettings {
  int points = 250;            ///< maximum number of points of a keyframe; 0: texture plays no part
  double sigma = 12.0;         ///< standard deviation of a point's brightness, of 255
  double min_gradient = 4.0;   ///< brightness per pixel in the keyframe; a smaller gradient aligns nothing
  double max_residual = 40.0;  ///< difference beyond which a point has no weight: a highlight, a shadow's edge
};

template <typename Visit>
void fields(const TextureModalitySettings& /*settings*/, const Visit& visit) {
  using S = TextureModalitySettings;
  visit(number("points", &S::points, 0, 100000));
  visit(number("sigma", &S::sigma, 1e-3, 1e3));
  visit(number("min_gradient", &S::min_gradient, 0, 255));
  visit(number("max_residual", &S::max_residual, 1e-3, 255));
}

/// Brightness of a part of a frame, fine and blurred, for gradients that reach as far.
struct BrightnessImage {
  static constexpr std::size_t kLevels = 2;
  std::array<cv::Mat, kLevels> levels;  ///< CV_32FC1, the finest first; empty where there is no colour
  cv::Point origin_px;                  ///< the first pixel in the frame
};

/// Returns the brightness of a part of the frame, which must lie inside the image.
BrightnessImage make_brightness(const RgbdFrame& frame, const cv::Rect& part_px);

/// Points of an object's surface with their brightness.
struct TextureKeyframe {
  struct Point {
    Eigen::Vector3f point = Eigen::Vector3f::Zero();           ///< object frame, metres
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();          ///< unit, object frame
    std::array<float, BrightnessImage::kLevels> brightness{};  ///< brightness by level
  };
  static constexpr std::size_t kMinPoints = 15;  ///< fewer points say nothing

  /// Returns whether there are enough points for equations.
  bool is_textured() const { return points.size() >= kMinPoints; }

  std::vector<Point> points;
};

/// Makes a keyframe of those points of the nearest view where depth agrees with the pose and the brightness changes.
TextureKeyframe make_texture_keyframe(const RegionView& view, const BrightnessImage& image,
                                      const Eigen::Isometry3d& T_camera_object,
                                      const TextureModalitySettings& settings);

/// Returns the normal equations of the motion that gives the points the brightness of the keyframe but for an offset
/// that all have in common, as region_equations() has them. Points behind nearer depth, turned away or outside the part
/// have no weight; there is no information where fewer than a handful are left.
MotionEquations texture_equations(const RegionView& view, const BrightnessImage& image, const TextureKeyframe& keyframe,
                                  const Eigen::Isometry3d& T_camera_object, std::size_t level,
                                  const TextureModalitySettings& settings);

}  // namespace houghstream
