#include "tools/studies/pose/surface_baseline.hpp"

#include <pcl/features/normal_3d.h>
#include <pcl/search/kdtree.h>

#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "pose/seen/depth_score.hpp"
#include "pose/seen/region.hpp"

namespace houghstream {
namespace {

/// A cell is a cube of space and the side that the surface faces.
using Cell = std::array<int, 4>;

Cell cell_of(const pcl::PointNormal& point, double spacing_m) {
  const auto part = [spacing_m](float x) { return static_cast<int>(std::floor(x / spacing_m)); };
  const Eigen::Vector3f normal = point.getNormalVector3fMap();
  Eigen::Index axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  return {part(point.x), part(point.y), part(point.z), static_cast<int>(2 * axis) + (normal[axis] < 0.0F ? 1 : 0)};
}

struct Sum {
  Eigen::Vector3f point = Eigen::Vector3f::Zero();
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  int count = 0;
};

SurfaceCloud::Ptr with_normals(const SurfaceCloud::Ptr& points, const SurfaceCloud::Ptr& among, double radius_m) {
  pcl::NormalEstimation<pcl::PointNormal, pcl::PointNormal> estimation;
  estimation.setInputCloud(points);
  estimation.setSearchSurface(among);
  estimation.setSearchMethod(pcl::make_shared<pcl::search::KdTree<pcl::PointNormal>>());
  estimation.setRadiusSearch(radius_m);
  SurfaceCloud normals;
  estimation.compute(normals);
  SurfaceCloud::Ptr out(new SurfaceCloud);
  for (std::size_t i = 0; i < points->size(); ++i) {
    if (!normals[i].getNormalVector3fMap().allFinite()) continue;
    out->push_back(normals[i]);
    out->back().getVector3fMap() = (*points)[i].getVector3fMap();
  }
  return out;
}

constexpr int kScoredPoints = 400;  // points of the model's view

}  // namespace

SurfaceCloud::Ptr thinned(const SurfaceCloud& cloud, double spacing_m) {
  std::map<Cell, Sum> cells;
  for (const pcl::PointNormal& point : cloud) {
    Sum& sum = cells[cell_of(point, spacing_m)];
    sum.point += point.getVector3fMap();
    sum.normal += point.getNormalVector3fMap();
    ++sum.count;
  }
  SurfaceCloud::Ptr out(new SurfaceCloud);
  for (const auto& [cell, sum] : cells) {
    pcl::PointNormal mean;
    mean.getVector3fMap() = sum.point / static_cast<float>(sum.count);
    mean.getNormalVector3fMap() = sum.normal.normalized();
    out->push_back(mean);
  }
  return out;
}

SurfaceCloud view_surface(const ModelView& view) {
  SurfaceCloud cloud;
  for (std::size_t i = 0; i < view.points.size(); ++i) {
    cloud.push_back({});
    cloud.back().getVector3fMap() = view.points[i];
    cloud.back().getNormalVector3fMap() = view.normals[i];
  }
  return cloud;
}

SurfaceCloud::Ptr model_surface(const ObjectModel& model, double spacing_m) {
  SurfaceCloud all;
  for (const ModelView& view : model.views) all += view_surface(view);
  return thinned(all, spacing_m);
}

SurfaceCloud::Ptr measured_surface(const RgbdFrame& frame, const DepthRegion& region, const SurfaceSettings& settings) {
  const SurfaceCloud::Ptr all(new SurfaceCloud);
  for (const Eigen::Vector3f& point : region_points(frame, region, settings.measured_points)) {
    all->push_back({});
    all->back().getVector3fMap() = point;
  }
  return with_normals(thinned(*all, settings.spacing_m), all, settings.normal_radius_m);
}

SurfaceRival::SurfaceRival(const std::map<std::string, Mesh>& models, const PoseSettings& pose,
                           const SurfaceSettings& surface)
    : pose_(pose), surface_(surface) {
  for (const auto& [name, mesh] : models) models_.emplace(name, make_object_model(name, mesh, pose.model));
}

std::optional<Eigen::Isometry3d> SurfaceRival::estimate(const RgbdFrame& frame, const Detection& detection) const {
  check_frame(frame, "pose rival");
  const auto found = models_.find(detection.class_name);
  if (found == models_.end() || !detection.centre_camera.allFinite()) return std::nullopt;
  const ObjectModel& model = found->second;
  const DepthRegion region = find_region(frame, detection, model, pose_.region);
  if (region.points < pose_.region.min_points) return std::nullopt;

  SeenSurface surface{frame, model, region};
  surface.cloud = measured_surface(frame, region, surface_);
  surface.centre_camera = detection.centre_camera.cast<double>();
  surface.max_shift_m = pose_.registration.max_shift_m;
  std::optional<Eigen::Isometry3d> best;
  float best_score = -std::numeric_limits<float>::infinity();
  for (const Eigen::Isometry3d& T_camera_object : propose(found->first, surface)) {
    if (!T_camera_object.matrix().allFinite() || !surface.reaches(T_camera_object)) continue;
    const DepthTolerance tolerance{pose_.verification.tolerance_m, pose_.noise};
    const float score = score_pose(frame, model, T_camera_object, kScoredPoints, tolerance).value;
    if (score <= best_score) continue;
    best_score = score;
    best = T_camera_object;
  }
  return best;
}

}  // namespace houghstream
