#include "tools/studies/pose/surface_cloud.hpp"

#include <pcl/features/normal_3d.h>
#include <pcl/search/kdtree.h>

#include <array>
#include <cmath>
#include <map>

namespace houghstream {
namespace {

/// A cube of space and the side that the surface faces.
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

}  // namespace houghstream
