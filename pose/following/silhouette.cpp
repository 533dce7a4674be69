#include "pose/following/silhouette.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "pipeline/geometry/renderer.hpp"

namespace houghstream {
namespace {

constexpr int kDiameter_px = 200;  // diameter of the sphere that holds the model, in the image that gives the outline

Eigen::Vector3d eye_of(const ObjectModel& model, const Eigen::Isometry3d& T_camera_object) {
  return T_camera_object.inverse().translation() - model.centre.cast<double>();
}

/// A rendered model whose outline is walked along.
struct OutlineView {
  Camera camera;
  Eigen::Isometry3d T_object_camera;
  cv::Mat depth;  ///< metres, NaN beside the model
  cv::Mat mask;   ///< CV_8UC1, 255 on the model

  bool is_model(const Eigen::Vector2d& pixel) const {
    const int x = cvRound(pixel.x());
    const int y = cvRound(pixel.y());
    return x >= 0 && y >= 0 && x < mask.cols && y < mask.rows && mask.at<std::uint8_t>(y, x) != 0;
  }
};

/// Renders the model from the camera's place, looking at its centre, so that the model fills the image.
OutlineView look_at_centre(const ObjectModel& model, const Eigen::Vector3d& eye) {
  constexpr int kMargin = 4;
  const int size = kDiameter_px + 2 * kMargin;
  const double focal = 0.5 * kDiameter_px / std::tan(std::asin(model.radius / eye.norm()));
  OutlineView view;
  view.camera = {size, size, focal, focal, 0.5 * (size - 1), 0.5 * (size - 1)};
  const Eigen::Quaterniond R = Eigen::Quaterniond::FromTwoVectors(eye, -Eigen::Vector3d::UnitZ());
  Eigen::Isometry3d T_camera_object = Eigen::Isometry3d::Identity();
  T_camera_object.linear() = R.toRotationMatrix();
  T_camera_object.translation() = Eigen::Vector3d(0.0, 0.0, eye.norm()) - R * model.centre.cast<double>();
  view.T_object_camera = T_camera_object.inverse();
  view.depth = render_depth(model.mesh, T_camera_object, view.camera, {0, 0, size, size});
  view.mask = view.depth == view.depth;  // NaN differs from itself
  return view;
}

/// Pixels along a direction from a place on, up to the first that is on the model or, for those that are, beside it.
int count_alike(const OutlineView& view, const Eigen::Vector2d& from, const Eigen::Vector2d& direction, bool on_model) {
  int count = 0;
  while (count < kDiameter_px && view.is_model(from + (count + 1.0) * direction) == on_model) ++count;
  return count;
}

/// Returns the direction out of the model at a place of a closed chain of the model's outermost pixels; zero where
/// there is none.
Eigen::Vector2d outward_at(const OutlineView& view, const std::vector<cv::Point>& chain, std::size_t i) {
  constexpr std::size_t kReach = 4;
  const std::size_t count = chain.size();
  const cv::Point along = chain[(i + kReach) % count] - chain[(i + count - kReach % count) % count];
  const double length = std::hypot(along.x, along.y);
  if (!(length > 0.0)) return Eigen::Vector2d::Zero();
  const Eigen::Vector2d across = Eigen::Vector2d(along.y, -along.x) / length;
  const Eigen::Vector2d at(chain[i].x, chain[i].y);
  const bool left = view.is_model(at + 2.0 * across);
  const bool right = view.is_model(at - 2.0 * across);
  if (left == right) return Eigen::Vector2d::Zero();  // so thin a model has no inside
  return left ? Eigen::Vector2d(-across) : across;
}

void add_point(const OutlineView& view, const std::vector<cv::Point>& chain, std::size_t i, Silhouette& silhouette) {
  constexpr int kBeside = 12;  // pixels
  const Eigen::Vector2d normal = outward_at(view, chain, i);
  if (normal.isZero(0.0)) return;
  const Eigen::Vector2d pixel(chain[i].x, chain[i].y);
  const double z = view.depth.at<float>(chain[i]);
  // The outermost pixels' middles are half a pixel inside along the axis that is nearer to the normal.
  const Eigen::Vector2d edge = pixel + 0.5 * normal.cwiseAbs().maxCoeff() * normal;
  const double metre = z / view.camera.fx;
  const int inside = count_alike(view, pixel, -normal, true);
  double nearest = z;
  for (int step = 1; step <= std::min(inside, kBeside); ++step) {
    const Eigen::Vector2d at = pixel - step * normal;
    nearest = std::min<double>(nearest, view.depth.at<float>(cvRound(at.y()), cvRound(at.x())));
  }
  SilhouettePoint& point = silhouette.points.emplace_back();
  point.point = (view.T_object_camera * view.camera.backproject(edge.x(), edge.y(), z)).cast<float>();
  point.normal = (view.T_object_camera.linear() * Eigen::Vector3d(normal.x(), normal.y(), 0.0)).cast<float>();
  point.inside_m = static_cast<float>(metre * inside);
  point.outside_m = static_cast<float>(metre * count_alike(view, pixel + normal, normal, false));
  point.nearer_m = static_cast<float>(z - nearest);
}

}  // namespace

Silhouette make_silhouette(const ObjectModel& model, const Eigen::Isometry3d& T_camera_object, int points) {
  constexpr double kNearest = 1.2;       // radii
  constexpr std::size_t kMinChain = 12;  // pixels: less is a speck
  const Eigen::Vector3d eye = eye_of(model, T_camera_object);
  Silhouette silhouette;
  silhouette.eye = eye.cast<float>();
  if (!(eye.norm() > kNearest * model.radius)) return silhouette;
  const OutlineView view = look_at_centre(model, eye);
  std::vector<std::vector<cv::Point>> chains;
  cv::findContours(view.mask.clone(), chains, cv::RETR_CCOMP, cv::CHAIN_APPROX_NONE);
  std::size_t all = 0;
  for (const auto& chain : chains) all += chain.size() >= kMinChain ? chain.size() : 0;
  const double step = std::max(1.0, static_cast<double>(all) / points);
  double next = 0.0;
  for (const auto& chain : chains) {
    if (chain.size() < kMinChain) continue;
    for (; next < static_cast<double>(chain.size()); next += step)
      add_point(view, chain, static_cast<std::size_t>(next), silhouette);
    next -= static_cast<double>(chain.size());
  }
  return silhouette;
}

bool is_silhouette_of(const Silhouette& silhouette, const ObjectModel& model,
                      const Eigen::Isometry3d& T_camera_object) {
  constexpr double kMinCosine = 0.9986;
  constexpr double kMaxScale = 1.1;
  const Eigen::Vector3d eye = eye_of(model, T_camera_object);
  const Eigen::Vector3d made = silhouette.eye.cast<double>();
  const double lengths = eye.norm() * made.norm();
  const double scale = eye.norm() / made.norm();
  return eye.dot(made) > kMinCosine * lengths && scale < kMaxScale && scale * kMaxScale > 1.0;
}

}  // namespace houghstream
