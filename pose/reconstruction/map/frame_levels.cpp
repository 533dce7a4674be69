#include "pose/reconstruction/map/frame_levels.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "pipeline/base/no_value.hpp"

namespace houghstream::reconstruction {
namespace {

/// Halves the size. A pixel's depth is the mean of those of its four that lie on the nearest surface.
cv::Mat half_depth(const cv::Mat& depth) {
  constexpr float kSameSurface = 1.02F;
  cv::Mat half(depth.rows / 2, depth.cols / 2, CV_32FC1);
  for (int y = 0; y < half.rows; ++y) {
    const float* above = depth.ptr<float>(2 * y);
    const float* below = depth.ptr<float>(2 * y + 1);
    for (int x = 0; x < half.cols; ++x) {
      const float four[4] = {above[2 * x], above[2 * x + 1], below[2 * x], below[2 * x + 1]};
      float nearest = std::numeric_limits<float>::max();
      for (const float z : four) nearest = z < nearest ? z : nearest;
      float sum = 0.0F;
      int count = 0;
      for (const float z : four) {
        if (!(z <= nearest * kSameSurface)) continue;
        sum += z;
        ++count;
      }
      half.at<float>(y, x) = count > 0 ? sum / static_cast<float>(count) : kNoValue;
    }
  }
  return half;
}

cv::Mat half_intensity(const cv::Mat& grey) {
  cv::Mat half;
  cv::resize(grey(cv::Rect(0, 0, grey.cols / 2 * 2, grey.rows / 2 * 2)), half, {grey.cols / 2, grey.rows / 2}, 0, 0,
             cv::INTER_AREA);
  return half;
}

Camera half_camera(const Camera& camera) {
  return {camera.width / 2, camera.height / 2,     camera.fx / 2,
          camera.fy / 2,    (camera.cx - 0.5) / 2, (camera.cy - 0.5) / 2};
}

/// Subtracts the local mean and divides by the local deviation. Noise on uniform surfaces is not amplified.
cv::Mat normalise_intensity(const cv::Mat& grey) {
  constexpr int kAround_px = 21;
  constexpr double kNoise = 6.0;  // grey levels
  cv::Mat values, mean, mean_sq;
  grey.convertTo(values, CV_32F);
  cv::boxFilter(values, mean, CV_32F, {kAround_px, kAround_px}, {-1, -1}, true, cv::BORDER_REFLECT);
  cv::sqrBoxFilter(values, mean_sq, CV_32F, {kAround_px, kAround_px}, {-1, -1}, true, cv::BORDER_REFLECT);
  cv::Mat intensity(grey.size(), CV_32FC1);
  for (int y = 0; y < grey.rows; ++y) {
    const float* v = values.ptr<float>(y);
    const float* m = mean.ptr<float>(y);
    const float* s = mean_sq.ptr<float>(y);
    float* out = intensity.ptr<float>(y);
    for (int x = 0; x < grey.cols; ++x) {
      const float variance = std::max(0.0F, s[x] - m[x] * m[x]);
      out[x] = (v[x] - m[x]) / (std::sqrt(variance) + static_cast<float>(kNoise));
    }
  }
  return intensity;
}

ImageQuality measure_quality(const cv::Mat& grey) {
  constexpr int kBlack = 6;
  constexpr int kBurnt = 250;
  ImageQuality quality;
  const double pixels = static_cast<double>(grey.total());
  quality.dark_fraction = cv::countNonZero(grey < kBlack) / pixels;
  quality.bright_fraction = cv::countNonZero(grey > kBurnt) / pixels;
  cv::Mat laplacian;
  cv::Laplacian(grey, laplacian, CV_16S, 3);
  cv::Scalar mean, deviation, edge_mean, edge_deviation;
  cv::meanStdDev(grey, mean, deviation);
  cv::meanStdDev(laplacian, edge_mean, edge_deviation);
  quality.sharpness = edge_deviation[0] * edge_deviation[0] / (deviation[0] * deviation[0] + 1.0);
  return quality;
}

/// Computes the normal of the plane through the depth around a pixel, towards the camera; 1/z is linear in the pixel
/// there.
bool fit_normal(const FrameLevel& level, int x, int y, Eigen::Vector3f& normal) {
  constexpr int kRadius_px = 3;
  constexpr int kMin = 30;  // minimum number of the 49 pixels
  const float z = level.depth.at<float>(y, x);
  const float same = 0.008F + 0.012F * z;
  Eigen::Matrix3f squares = Eigen::Matrix3f::Zero();
  Eigen::Vector3f sums = Eigen::Vector3f::Zero();
  int count = 0;
  for (int v = -kRadius_px; v <= kRadius_px; ++v) {
    const float* row = level.depth.ptr<float>(y + v);
    for (int u = -kRadius_px; u <= kRadius_px; ++u) {
      const float near_z = row[x + u];
      if (!(std::abs(near_z - z) < same)) continue;
      const Eigen::Vector3f ray(static_cast<float>(u), static_cast<float>(v), 1.0F);
      squares += ray * ray.transpose();
      sums += ray / near_z;
      ++count;
    }
  }
  if (count < kMin) return false;
  // The plane is 1/z = a u + b v + c about the pixel; the plane n.X = 1 has n = (a fx, b fy, c - a (x - cx) - b (y -
  // cy)).
  const Eigen::Vector3f f = squares.ldlt().solve(sums);
  const auto fx = static_cast<float>(level.camera.fx);
  const auto fy = static_cast<float>(level.camera.fy);
  normal = {f.x() * fx, f.y() * fy,
            f.z() - f.x() * (static_cast<float>(x) - static_cast<float>(level.camera.cx)) -
                f.y() * (static_cast<float>(y) - static_cast<float>(level.camera.cy))};
  const float length = normal.norm();
  if (!(length > 0.0F)) return false;
  normal /= -length;
  return true;
}

/// Finds the pixel of a grid cell with depth and the strongest intensity gradient.
bool strongest_pixel(const FrameLevel& level, const cv::Rect& cell, const cv::Mat& mask, cv::Point& best) {
  float strongest = -1.0F;
  for (int y = cell.y; y < cell.br().y; ++y) {
    for (int x = cell.x; x < cell.br().x; ++x) {
      if (!(level.depth.at<float>(y, x) > 0.0F) || (!mask.empty() && mask.at<std::uint8_t>(y, x) == 0)) continue;
      const float gx = level.intensity.at<float>(y, x + 1) - level.intensity.at<float>(y, x - 1);
      const float gy = level.intensity.at<float>(y + 1, x) - level.intensity.at<float>(y - 1, x);
      const float edge = gx * gx + gy * gy;
      if (edge <= strongest) continue;
      strongest = edge;
      best = {x, y};
    }
  }
  return strongest >= 0.0F;
}

std::vector<SurfacePoint> points_of(const FrameLevel& level, const cv::Mat& mask, int cell_px, double min_facing) {
  constexpr int kBorder_px = 4;
  std::vector<SurfacePoint> points;
  for (int y = kBorder_px; y + cell_px <= level.depth.rows - kBorder_px; y += cell_px) {
    for (int x = kBorder_px; x + cell_px <= level.depth.cols - kBorder_px; x += cell_px) {
      cv::Point px;
      if (!strongest_pixel(level, {x, y, cell_px, cell_px}, mask, px)) continue;
      SurfacePoint point;
      if (!fit_normal(level, px.x, px.y, point.normal)) continue;
      point.point = level.camera.backproject(px.x, px.y, level.depth.at<float>(px)).cast<float>();
      if (-point.normal.dot(point.point.normalized()) < static_cast<float>(min_facing)) continue;
      const bool is_static = !level.static_mask.empty() && level.static_mask.at<std::uint8_t>(px) != 0;
      point.intensity = is_static ? kNoValue : level.intensity.at<float>(px);
      points.push_back(point);
    }
  }
  return points;
}

}  // namespace

FrameLevels make_levels(const RgbdFrame& frame, const LevelSettings& settings) {
  const cv::Rect whole({0, 0}, frame.depth.size());
  const cv::Rect region = settings.region_px.empty() ? whole : settings.region_px & whole;
  FrameLevels out;
  cv::Mat grey;
  cv::cvtColor(frame.colour(region), grey, cv::COLOR_BGR2GRAY);
  cv::Mat depth = frame.depth(region);
  Camera camera = frame.camera.cropped(region.x, region.y, region.width, region.height);
  while (grey.cols > settings.min_width) {
    grey = half_intensity(grey);
    depth = half_depth(depth);
    camera = half_camera(camera);
  }
  out.quality = measure_quality(grey);
  for (int level = 0; level < settings.levels; ++level) {
    if (level > 0) {
      grey = half_intensity(grey);
      depth = half_depth(depth);
      camera = half_camera(camera);
    }
    out.levels.push_back({camera, normalise_intensity(grey), depth, {}});
  }
  return out;
}

LevelPoints choose_points(const FrameLevels& frame, const cv::Mat& mask, const PointSettings& settings) {
  LevelPoints points;
  cv::Mat at_level = mask;
  double cell = settings.cell_px;
  for (const FrameLevel& level : frame.levels) {
    if (!mask.empty() && at_level.size() != level.depth.size())
      cv::resize(mask, at_level, level.depth.size(), 0, 0, cv::INTER_NEAREST);
    points.push_back(points_of(level, at_level, std::max(2, static_cast<int>(std::lround(cell))), settings.min_facing));
    cell *= 0.75;
  }
  return points;
}

}  // namespace houghstream::reconstruction
