#include "detector/baseline/surface_neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "detector/baseline/surface_normals.hpp"
#include "detector/baseline/surface_window.hpp"
#include "pipeline/base/no_value.hpp"
#include "pipeline/base/parallel.hpp"

namespace houghstream::baseline {

namespace {

/// Returns about `count` places spread evenly over the unit disk.
std::vector<cv::Point2f> disk(int count) {
  const double pitch = std::sqrt(M_PI / count);
  const int reach = static_cast<int>(1.0 / pitch);
  std::vector<cv::Point2f> places;
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -reach; x <= reach; ++x) {
      const cv::Point2f place(static_cast<float>(x * pitch), static_cast<float>(y * pitch));
      if (place.dot(place) <= 1.0F) places.push_back(place);
    }
  }
  return places;
}

/// Returns the pixels that these places of a unit disk fall on in a disk of radius `reach` pixels, each once, nearest
/// first.
std::vector<cv::Point> shifts_of(const std::vector<cv::Point2f>& places, float reach) {
  std::vector<cv::Point> shifts;
  shifts.reserve(places.size());
  for (const cv::Point2f& place : places) shifts.emplace_back(place * reach);
  const auto rank = [](const cv::Point& p) { return std::make_tuple(p.dot(p), p.y, p.x); };
  std::sort(shifts.begin(), shifts.end(), [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
  shifts.erase(std::unique(shifts.begin(), shifts.end()), shifts.end());
  return shifts;
}

/// Returns the radius, metres, of the disk that so many points of the cloud in which neighbours are counted cover.
float support_radius(const PointHistogramSettings& settings, int neighbours) {
  return settings.spacing * std::sqrt(static_cast<float>(neighbours) / static_cast<float>(M_PI));
}

/// Fits the plane through the pixels at these offsets of a disk of so many metres; NaN where too few are on the
/// surface.
Eigen::Vector3f normal_at(const WorkingFrame& frame, cv::Point at, const std::vector<cv::Point2f>& places,
                          float radius) {
  constexpr float kMinReach = 1.5F;  // pixels
  const float depth = frame.filled_depth.at<float>(at);
  const Eigen::Vector3d middle = frame.camera.backproject(at.x, at.y, depth);
  const float reach_px = std::max(kMinReach, radius / static_cast<float>(frame.camera.metres_per_px(depth)));
  const float limit = same_surface_limit(radius);
  const cv::Rect inside(0, 0, frame.filled_depth.cols, frame.filled_depth.rows);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  std::size_t count = 0;
  for (const cv::Point2f& place : places) {
    const cv::Point p = at + cv::Point(place * reach_px);
    if (!inside.contains(p)) continue;
    const float z = frame.filled_depth.at<float>(p);
    if (!(std::fabs(z - depth) < limit)) continue;
    const Eigen::Vector3d apart = frame.camera.backproject(p.x, p.y, z) - middle;
    sum += apart;
    squares += apart * apart.transpose();
    ++count;
  }
  if (count * 4 < places.size()) return Eigen::Vector3f::Constant(kNoValue);
  const double n = static_cast<double>(count);
  const Eigen::Vector3d mean = sum / n;
  return facing_normal(squares / n - mean * mean.transpose(), middle).cast<float>();
}

HistogramCloud empty_cloud(cv::Size pixels, const PointHistogramSettings& settings) {
  HistogramCloud cloud;
  cloud.step_px = settings.step_px;
  cloud.size = {(pixels.width + settings.step_px - 1) / settings.step_px,
                (pixels.height + settings.step_px - 1) / settings.step_px};
  const auto count = static_cast<std::size_t>(cloud.size.area());
  cloud.points.assign(static_cast<pcl::index_t>(count), pcl::PointXYZ(kNoValue, kNoValue, kNoValue));
  cloud.normals.resize(count);
  cloud.reaches.resize(count, 0.0F);
  const std::vector<cv::Point2f> places = disk(settings.given);
  const int steps = static_cast<int>(HistogramCloud::kMaxDistance / HistogramCloud::kReachStep);
  for (int i = 0; i <= steps; ++i) {  // the points beside are still neighbours where surfaces are far away
    const float reach = std::max(1.0F, static_cast<float>(i) * HistogramCloud::kReachStep);
    cloud.shifts.push_back(shifts_of(places, reach));
  }
  return cloud;
}

}  // namespace

HistogramCloud make_histogram_cloud(const WorkingFrame& frame, const PointHistogramSettings& settings, int threads) {
  const cv::Size pixels = frame.filled_depth.size();
  HistogramCloud cloud = empty_cloud(pixels, settings);
  const std::vector<cv::Point2f> normal_places = disk(settings.normal_neighbours);
  const float normal_radius = support_radius(settings, settings.normal_neighbours);
  const float radius = support_radius(settings, settings.neighbours);
  cloud.limit = same_surface_limit(radius);
  parallel_for(threads, cloud.size.height, [&](int gy) {
    for (int gx = 0; gx < cloud.size.width; ++gx) {
      const cv::Point at(std::min(gx * cloud.step_px + cloud.step_px / 2, pixels.width - 1),
                         std::min(gy * cloud.step_px + cloud.step_px / 2, pixels.height - 1));
      const float depth = frame.filled_depth.at<float>(at);
      if (std::isnan(depth)) continue;
      const std::size_t i = cloud.index(gx, gy);
      const Eigen::Vector3f normal = normal_at(frame, at, normal_places, normal_radius);
      if (std::isnan(normal.z())) continue;
      cloud.points[i].getVector3fMap() = frame.camera.backproject(at.x, at.y, depth).cast<float>();
      cloud.normals[i].getNormalVector3fMap() = normal;
      const auto reach_px = radius / static_cast<float>(frame.camera.metres_per_px(depth));
      cloud.reaches[i] = std::min(HistogramCloud::kMaxDistance, reach_px / static_cast<float>(cloud.step_px));
    }
  });
  return cloud;
}

CloudNeighbours neighbours_of(const HistogramCloud& cloud, int x, int y) {
  CloudNeighbours found;
  const std::size_t middle = cloud.index(x, y);
  if (std::isnan(cloud.points[middle].z)) return found;
  const auto reach = static_cast<std::size_t>(std::lround(cloud.reaches[middle] / HistogramCloud::kReachStep));
  const cv::Rect inside({0, 0}, cloud.size);
  for (const cv::Point& shift : cloud.shifts[reach]) {
    const cv::Point at = cv::Point(x, y) + shift;
    if (!inside.contains(at)) continue;
    const std::size_t i = cloud.index(at.x, at.y);
    const Eigen::Vector3f apart = cloud.points[i].getVector3fMap() - cloud.points[middle].getVector3fMap();
    if (!(std::fabs(apart.z()) < cloud.limit)) continue;  // also where there is no point
    found.indices.push_back(static_cast<pcl::index_t>(i));
    found.distances_sq.push_back(apart.squaredNorm());
  }
  return found;
}

}  // namespace houghstream::baseline
