#include "tools/evaluate/metrics/bop_errors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pipeline/geometry/renderer.hpp"

namespace houghstream {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
using Vertices = std::vector<Eigen::Vector3f>;

/// Projects vertices; returns none where a vertex does not lie in front of the camera.
std::vector<Eigen::Vector2d> projected(const Vertices& vertices, const Eigen::Isometry3d& T, const Camera& camera) {
  std::vector<Eigen::Vector2d> out;
  out.reserve(vertices.size());
  for (const Eigen::Vector3f& vertex : vertices) {
    const Eigen::Vector3d point = T * vertex.cast<double>();
    if (!(point.z() > 0.0)) return {};
    out.push_back(camera.project(point));
  }
  return out;
}

/// Returns the largest squared distance between the projections, or any from `enough` on.
double max_sq(const std::vector<Eigen::Vector2d>& estimated, const Vertices& vertices, const Eigen::Isometry3d& T,
              const Camera& camera, double enough) {
  double farthest = 0.0;
  for (std::size_t i = 0; i < vertices.size() && farthest < enough; ++i) {
    const Eigen::Vector3d point = T * vertices[i].cast<double>();
    if (!(point.z() > 0.0)) return kInfinity;
    farthest = std::max(farthest, (camera.project(point) - estimated[i]).squaredNorm());
  }
  return farthest;
}

/// Returns the part of the image in which the object can be seen in either pose: all of it where the object is too near
/// to say.
cv::Rect seen_region(const Vertices& vertices, const Eigen::Isometry3d& T_estimated,
                     const Eigen::Isometry3d& T_ground_truth, const Camera& camera) {
  const cv::Rect image(0, 0, camera.width, camera.height);
  Eigen::AlignedBox2d bounds;
  for (const Eigen::Isometry3d* T : {&T_estimated, &T_ground_truth}) {
    const std::vector<Eigen::Vector2d> points = projected(vertices, *T, camera);
    if (points.empty()) return image;
    for (const Eigen::Vector2d& point : points) bounds.extend(point);
  }
  const Eigen::Array2d edge(camera.width, camera.height);
  const Eigen::Array2i low = bounds.min().array().max(0.0).min(edge).floor().cast<int>();
  const Eigen::Array2i high = (bounds.max().array() + 2.0).max(0.0).min(edge).floor().cast<int>();
  return cv::Rect(low.x(), low.y(), high.x() - low.x(), high.y() - low.y()) & image;
}

/// Pixel counts of VSD.
struct PixelCounts {
  int in_either = 0;
  int in_both = 0;
  std::array<int, kBopSteps> apart = {};  ///< pixels apart by tau, of those in both
};

/// Adds one pixel; distances along its ray, metres, NaN where there is none.
void count_pixel(double estimated, double truth, double measured, double diameter, PixelCounts& counts) {
  constexpr double kDelta = 0.015;
  const auto visible = [&](double model) { return std::isfinite(model) && !(model - measured > kDelta); };
  const bool ground_truth_visible = visible(truth);
  // An estimate behind the visible true object is not hidden but wrong.
  const bool estimate_visible = visible(estimated) || (ground_truth_visible && std::isfinite(estimated));
  counts.in_either += ground_truth_visible || estimate_visible ? 1 : 0;
  if (!ground_truth_visible || !estimate_visible) return;
  ++counts.in_both;
  for (std::size_t i = 0; i < kBopSteps; ++i) {
    counts.apart[i] += std::abs(truth - estimated) / diameter >= bop_step(i) ? 1 : 0;
  }
}

}  // namespace

double mssd_error(const Vertices& vertices, const std::vector<Eigen::Isometry3d>& symmetries,
                  const Eigen::Isometry3d& T_estimated, const Eigen::Isometry3d& T_ground_truth) {
  double best_sq = kInfinity;
  for (const Eigen::Isometry3d& symmetry : symmetries) {
    const Eigen::Isometry3d T = T_ground_truth * symmetry;
    const Eigen::Matrix3d A = T_estimated.linear() - T.linear();
    const Eigen::Vector3d b = T_estimated.translation() - T.translation();
    double farthest = 0.0;
    for (std::size_t i = 0; i < vertices.size() && farthest < best_sq; ++i)
      farthest = std::max(farthest, (A * vertices[i].cast<double>() + b).squaredNorm());
    best_sq = std::min(best_sq, farthest);
  }
  return std::sqrt(best_sq);
}

double mspd_error(const Vertices& vertices, const std::vector<Eigen::Isometry3d>& symmetries,
                  const Eigen::Isometry3d& T_estimated, const Eigen::Isometry3d& T_ground_truth, const Camera& camera) {
  const std::vector<Eigen::Vector2d> estimated = projected(vertices, T_estimated, camera);
  if (estimated.empty()) return kInfinity;
  double best_sq = kInfinity;
  for (const Eigen::Isometry3d& symmetry : symmetries)
    best_sq = std::min(best_sq, max_sq(estimated, vertices, T_ground_truth * symmetry, camera, best_sq));
  return std::sqrt(best_sq);
}

std::array<double, kBopSteps> vsd_errors(const Mesh& mesh, double diameter, const Eigen::Isometry3d& T_estimated,
                                         const Eigen::Isometry3d& T_ground_truth, const RgbdFrame& frame) {
  const cv::Rect region = seen_region(mesh.vertices, T_estimated, T_ground_truth, frame.camera);
  std::array<double, kBopSteps> errors;
  errors.fill(1.0);
  if (region.empty()) return errors;
  const cv::Mat estimated = render_depth(mesh, T_estimated, frame.camera, region);
  const cv::Mat truth = render_depth(mesh, T_ground_truth, frame.camera, region);
  PixelCounts counts;
  for (int y = 0; y < region.height; ++y) {
    for (int x = 0; x < region.width; ++x) {
      const cv::Point pixel(region.x + x, region.y + y);
      const double ray = frame.camera.backproject(pixel.x, pixel.y, 1.0).norm();
      count_pixel(ray * estimated.at<float>(y, x), ray * truth.at<float>(y, x), ray * frame.depth.at<float>(pixel),
                  diameter, counts);
    }
  }
  if (counts.in_either == 0) return errors;
  for (std::size_t i = 0; i < kBopSteps; ++i) {
    errors[i] = static_cast<double>(counts.apart[i] + counts.in_either - counts.in_both) / counts.in_either;
  }
  return errors;
}

BopErrors bop_errors(const BopModel& model, const Eigen::Isometry3d& T_estimated,
                     const Eigen::Isometry3d& T_ground_truth, const RgbdFrame& frame) {
  constexpr double kBopWidth_px = 640.0;
  const auto& vertices = model.mesh.vertices;
  return {mssd_error(vertices, model.symmetries, T_estimated, T_ground_truth) / model.diameter,
          mspd_error(vertices, model.symmetries, T_estimated, T_ground_truth, frame.camera) * kBopWidth_px /
              frame.camera.width,
          vsd_errors(model.mesh, model.diameter, T_estimated, T_ground_truth, frame)};
}

}  // namespace houghstream
