#include "pose/seen/foreground_search.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "pipeline/base/random.hpp"
#include "pipeline/geometry/plane_fit.hpp"
#include "pose/seen/colour_discriminant.hpp"

namespace houghstream {
namespace {

constexpr double kOnPlane_m = 0.006;  // distance within which a point belongs to a plane
constexpr int kMinPixels = 60;        // of the plane's colours, and of the foreground

/// Returns the plane of most points, nothing where these are fewer than half.
std::optional<Plane> find_plane(const ObjectObservation& observation) {
  constexpr int kPoints = 600;
  constexpr std::size_t kMinPoints = 50;
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3f& point : region_points(observation.frame, observation.region, kPoints))
    points.push_back(point.cast<double>());
  if (points.size() < kMinPoints) return std::nullopt;
  const auto limit_m = [](const Eigen::Vector3d& /*point*/) { return kOnPlane_m; };
  const auto weight = [](const Eigen::Vector3d& /*point*/) { return 1.0; };
  Random random(1);
  const std::optional<Plane> largest = find_largest_plane(points, limit_m, PlaneSearch{}, random);
  if (!largest) return std::nullopt;
  const std::vector<Eigen::Vector3d> on = points_on(*largest, points, limit_m);
  if (2 * on.size() < points.size()) return std::nullopt;
  return fit_plane(points_on(fit_plane(on, weight), points, limit_m), weight);
}

/// Returns the height above the plane, CV_32FC1, metres; NaN where nothing is measured.
cv::Mat heights_above(const Plane& plane, const ObjectObservation& observation) {
  const LabRegion& colours = observation.colours;
  cv::Mat heights(colours.lab.size(), CV_32FC1);
  for (int y = 0; y < heights.rows; ++y) {
    for (int x = 0; x < heights.cols; ++x) {
      const cv::Point at = cv::Point(x, y) + colours.origin_px;
      const double depth = observation.frame.depth.at<float>(at);
      heights.at<float>(y, x) =
          static_cast<float>(plane.signedDistance(observation.frame.camera.backproject(at.x, at.y, depth)));
    }
  }
  return heights;
}

/// Returns the colours of the plane at the edge of the region, which is larger than the detection's box.
ColourMoments colours_of_plane(const LabRegion& colours, const cv::Mat& heights, double limit_m) {
  constexpr double kEdge = 0.115;  // fraction of each side: what RegionSettings::enlarge adds, of the enlarged
  const cv::Size size = colours.lab.size();
  const cv::Rect inner(cvRound(kEdge * size.width), cvRound(kEdge * size.height),
                       cvRound((1.0 - 2.0 * kEdge) * size.width), cvRound((1.0 - 2.0 * kEdge) * size.height));
  ColourMoments moments;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      if (!inner.contains({x, y}) && std::abs(heights.at<float>(y, x)) < limit_m)
        moments.add(colours.lab.at<cv::Vec3b>(y, x));
    }
  }
  return moments;
}

/// Returns the evidence of each pixel of the region.
cv::Mat find_evidence(const LabRegion& colours, const cv::Mat& heights, const ColourMoments& plane, double lowest_m,
                      double highest_m) {
  constexpr double kNoise = 9.0;    // variance of a channel
  constexpr double kNear_sq = 9.0;  // squared Mahalanobis distance from the plane's colours that tells nothing
  const Eigen::Matrix3d information = (plane.covariance() + kNoise * Eigen::Matrix3d::Identity()).inverse();
  const Eigen::Vector3d mean = plane.mean();
  cv::Mat evidence(heights.size(), CV_32FC1);
  for (int y = 0; y < heights.rows; ++y) {
    for (int x = 0; x < heights.cols; ++x) {
      const auto& lab = colours.lab.at<cv::Vec3b>(y, x);
      const Eigen::Vector3d off = Eigen::Vector3d(lab[0], lab[1], lab[2]) - mean;
      const double differs = std::clamp(off.dot(information * off) / kNear_sq - 1.0, -1.0, 1.0);
      const float height = heights.at<float>(y, x);
      const bool is_elsewhere = height < lowest_m || height > highest_m;  // false for NaN
      evidence.at<float>(y, x) = is_elsewhere ? -1.0F : static_cast<float>(differs);
    }
  }
  return evidence;
}

/// Returns the mean pixel of the foreground within the model's radius of the detection, in the frame.
std::optional<Eigen::Vector2d> find_middle(const cv::Mat& evidence, const ObjectObservation& observation) {
  constexpr float kSure = 0.5F;
  const Eigen::Vector3d detected = observation.centre_camera.cast<double>();
  const Eigen::Vector2d detected_px = observation.frame.camera.project(detected);
  const double reach_px =
      static_cast<double>(observation.model.radius) / observation.frame.camera.metres_per_px(detected.z());
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  int count = 0;
  for (int y = 0; y < evidence.rows; ++y) {
    for (int x = 0; x < evidence.cols; ++x) {
      const Eigen::Vector2d at(x + observation.colours.origin_px.x, y + observation.colours.origin_px.y);
      if (evidence.at<float>(y, x) < kSure || (at - detected_px).norm() > reach_px) continue;
      sum += at;
      ++count;
    }
  }
  return count < kMinPixels ? std::nullopt : std::optional<Eigen::Vector2d>(sum / count);
}

}  // namespace

float mean_evidence(const SurfaceForeground& foreground, const ProjectedView& projected) {
  const cv::Mat& evidence = foreground.evidence;
  const cv::Rect part(foreground.origin_px, evidence.size());
  float sum = 0.0F;
  for (const ProjectedPoint& point : projected.points) {
    const cv::Point at(point.x, point.y);
    sum += part.contains(at) ? evidence.at<float>(at - foreground.origin_px) : -1.0F;
  }
  return projected.points.empty() ? -1.0F : sum / static_cast<float>(projected.points.size());
}

std::optional<SurfaceForeground> find_surface_foreground(const ObjectObservation& observation) {
  if (observation.colours.lab.empty()) return std::nullopt;
  const std::optional<Plane> plane = find_plane(observation);
  if (!plane) return std::nullopt;
  const double limit_m = kOnPlane_m + 2.0 * observation.noise.sigma(static_cast<double>(observation.centre_camera.z()));
  const cv::Mat heights = heights_above(*plane, observation);
  const ColourMoments table = colours_of_plane(observation.colours, heights, limit_m);
  if (table.count() < kMinPixels) return std::nullopt;
  SurfaceForeground foreground{*plane, observation.colours.origin_px, {}};
  const double highest_m = static_cast<double>(observation.model.thickness) + limit_m;
  foreground.evidence = find_evidence(observation.colours, heights, table, -limit_m, highest_m);
  const std::optional<Eigen::Vector2d> middle_px = find_middle(foreground.evidence, observation);
  if (!middle_px) return std::nullopt;
  const Eigen::Vector3d ray = observation.frame.camera.backproject(middle_px->x(), middle_px->y(), 1.0);
  foreground.centre = -plane->offset() / plane->normal().dot(ray) * ray;
  return foreground;
}

}  // namespace houghstream
