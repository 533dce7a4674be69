#include "pose/following/texture_modality.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>

namespace houghstream {
namespace {

constexpr float kMinFacing = 0.35F;                                  // cosine between normal and line of sight
constexpr std::array<int, BrightnessImage::kLevels> kStep = {1, 3};  // pixels to each side of a gradient

/// Brightness and its derivatives at a place.
struct BrightnessSample {
  float value = 0.0F;
  Eigen::Vector2f gradient = Eigen::Vector2f::Zero();  // brightness per pixel
};

float bilinear(const cv::Mat& image, float x, float y) {
  const int left = static_cast<int>(x);
  const int top = static_cast<int>(y);
  const float* row = image.ptr<float>(top) + left;
  const float* next = image.ptr<float>(top + 1) + left;
  const float dx = x - static_cast<float>(left);
  const float dy = y - static_cast<float>(top);
  return (1.0F - dy) * ((1.0F - dx) * row[0] + dx * row[1]) + dy * ((1.0F - dx) * next[0] + dx * next[1]);
}

/// Returns nothing at the part's border.
std::optional<BrightnessSample> sample_brightness(const BrightnessImage& image, const Eigen::Vector2f& pixel,
                                                  std::size_t level) {
  const cv::Mat& values = image.levels[level];
  const auto step = static_cast<float>(kStep[level]);
  const float x = pixel.x() - static_cast<float>(image.origin_px.x);
  const float y = pixel.y() - static_cast<float>(image.origin_px.y);
  const float margin = step + 1.0F;
  if (!(x >= margin && y >= margin && x < static_cast<float>(values.cols) - 1.0F - margin &&
        y < static_cast<float>(values.rows) - 1.0F - margin))
    return std::nullopt;
  BrightnessSample sample;
  sample.value = bilinear(values, x, y);
  sample.gradient = {(bilinear(values, x + step, y) - bilinear(values, x - step, y)) / (2.0F * step),
                     (bilinear(values, x, y + step) - bilinear(values, x, y - step)) / (2.0F * step)};
  return sample;
}

/// Returns the nearest whole number, of two the one farther from zero: std::lround() as a few instructions.
int rounded(float value) {
  const int whole = static_cast<int>(value);
  const float rest = value - static_cast<float>(whole);
  return whole + (rest >= 0.5F ? 1 : 0) - (rest <= -0.5F ? 1 : 0);
}

/// A point of the surface in a frame; nothing where it is turned away, or nearer or farther depth is measured.
struct SurfacePoint {
  Eigen::Vector3f point = Eigen::Vector3f::Zero();  // camera frame, metres
  Eigen::Vector2f pixel = Eigen::Vector2f::Zero();
};

std::optional<SurfacePoint> find_surface_point(const RegionView& view, const Eigen::Isometry3f& T,
                                               const Eigen::Vector3f& point, const Eigen::Vector3f& normal) {
  constexpr double kTolerance_m = 0.008;
  SurfacePoint out;
  out.point = T * point;
  if (!(out.point.z() > 0.0F) || -(T.linear() * normal).dot(out.point) < kMinFacing * out.point.norm())
    return std::nullopt;
  out.pixel = view.frame.camera.project_single(out.point);
  const int x = rounded(std::clamp(out.pixel.x(), -1.0F, 1e5F));
  const int y = rounded(std::clamp(out.pixel.y(), -1.0F, 1e5F));
  if (x < 0 || y < 0 || x >= view.frame.depth.cols || y >= view.frame.depth.rows) return std::nullopt;
  const float beyond = view.frame.depth.at<float>(y, x) - out.point.z();
  const double tolerance = DepthTolerance{kTolerance_m, view.noise}.at(out.point.z());
  if (std::abs(beyond) > tolerance) return std::nullopt;  // an unmeasured point may be visible
  return out;
}

/// A point of the keyframe with its difference in the frame.
struct Compared {
  Eigen::Matrix<double, 6, 1> row;
  float residual = 0.0F;  // brightness of the keyframe less that of the frame
};

float median_residual(const std::vector<Compared>& compared) {
  std::vector<float> values;
  values.reserve(compared.size());
  for (const Compared& one : compared) values.push_back(one.residual);
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

BrightnessImage make_brightness(const RgbdFrame& frame, const cv::Rect& part_px) {
  constexpr int kFine = 3;  // number of pixels that are averaged
  constexpr int kBlurred = 7;
  BrightnessImage image;
  image.origin_px = part_px.tl();
  if (part_px.area() == 0 || frame.colour.empty()) return image;
  cv::Mat grey;
  cv::cvtColor(frame.colour(part_px), grey, cv::COLOR_BGR2GRAY);
  grey.convertTo(grey, CV_32F);
  cv::blur(grey, image.levels[0], cv::Size(kFine, kFine));
  cv::blur(image.levels[0], image.levels[1], cv::Size(kBlurred, kBlurred));
  return image;
}

TextureKeyframe make_texture_keyframe(const RegionView& view, const BrightnessImage& image,
                                      const Eigen::Isometry3d& T_camera_object,
                                      const TextureModalitySettings& settings) {
  TextureKeyframe keyframe;
  if (image.levels[0].empty()) return keyframe;
  const Eigen::Isometry3f T = T_camera_object.cast<float>();
  const ModelView& points = nearest_view(view.model, T_camera_object);
  for (std::size_t i = 0; i < points.points.size(); ++i) {
    if (static_cast<int>(keyframe.points.size()) >= settings.points) break;
    const std::optional<SurfacePoint> at = find_surface_point(view, T, points.points[i], points.normals[i]);
    if (!at) continue;
    TextureKeyframe::Point point{points.points[i], points.normals[i], {}};
    float gradient = 0.0F;
    bool is_inside = true;
    for (std::size_t level = 0; level < BrightnessImage::kLevels; ++level) {
      const std::optional<BrightnessSample> sample = sample_brightness(image, at->pixel, level);
      is_inside = is_inside && sample;
      if (!sample) continue;
      point.brightness[level] = sample->value;
      gradient = std::max(gradient, sample->gradient.norm());
    }
    if (is_inside && gradient >= settings.min_gradient) keyframe.points.push_back(point);
  }
  return keyframe;
}

MotionEquations texture_equations(const RegionView& view, const BrightnessImage& image, const TextureKeyframe& keyframe,
                                  const Eigen::Isometry3d& T_camera_object, std::size_t level,
                                  const TextureModalitySettings& settings) {
  MotionEquations equations;
  if (image.levels[level].empty() || !keyframe.is_textured()) return equations;
  const Eigen::Isometry3f T = T_camera_object.cast<float>();
  const Eigen::Vector3d centre = T_camera_object * view.model.centre.cast<double>();
  std::vector<Compared> compared;
  compared.reserve(keyframe.points.size());
  for (const TextureKeyframe::Point& point : keyframe.points) {
    const std::optional<SurfacePoint> at = find_surface_point(view, T, point.point, point.normal);
    if (!at) continue;
    const std::optional<BrightnessSample> sample = sample_brightness(image, at->pixel, level);
    if (!sample) continue;
    const Eigen::Vector2d gradient = sample->gradient.cast<double>();
    compared.push_back(
        {image_motion_row(view, at->point.cast<double>(), gradient, centre), point.brightness[level] - sample->value});
  }
  if (compared.size() < TextureKeyframe::kMinPoints) return equations;
  const float offset = median_residual(compared);
  const double information = 1.0 / (settings.sigma * settings.sigma);
  for (const Compared& one : compared) {
    const double residual = static_cast<double>(one.residual - offset);
    const double ratio = residual / settings.max_residual;
    if (!(std::abs(ratio) < 1.0)) continue;
    const double left = 1.0 - ratio * ratio;
    const double weight = information * left * left;  // Tukey's biweight
    add_outer_product(one.row, weight, equations.hessian);
    equations.gradient += weight * residual * one.row;
  }
  return equations;
}

}  // namespace houghstream
