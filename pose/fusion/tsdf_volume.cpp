#include "pose/fusion/tsdf_volume.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/parallel.hpp"

namespace houghstream::fusion {
namespace {

/// Part of the space around the views' points that holds the object.
struct Extent {
  Eigen::Vector3d low, high;                     ///< object frame, metres
  bool stands = false;                           ///< all views look from one side
  Eigen::Vector3d up = Eigen::Vector3d::Zero();  ///< unit length, towards that side
  double base = 0.0;                             ///< lowest that was seen along `up`, metres
  double top = 0.0;                              ///< highest that was seen along `up`, metres
};

std::vector<Eigen::Vector3d> object_points(const std::vector<DepthView>& views) {
  constexpr int kPointsPerView = 4000;
  std::vector<Eigen::Vector3d> points;
  for (const DepthView& view : views) {
    const Eigen::Isometry3d T_object_camera = view.T_camera_object.inverse();
    for (const SurfaceSample& s : sample_view(view, kPointsPerView)) points.push_back(T_object_camera * s.point);
  }
  return points;
}

/// Returns the range of points along an axis. Stray points of a few views do not count.
std::array<double, 2> range_along(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& direction) {
  std::vector<double> along;
  along.reserve(points.size());
  for (const Eigen::Vector3d& point : points) along.push_back(direction.dot(point));
  std::sort(along.begin(), along.end());
  const std::size_t stray = along.size() / 500;
  return {along[stray], along[along.size() - 1 - stray]};
}

Extent find_extent(const std::vector<DepthView>& views) {
  constexpr double kOneSided = 0.1;  // mean of the directions to the cameras; a ring 6 degrees above the horizon
  const std::vector<Eigen::Vector3d> points = object_points(views);
  require(!points.empty(), "{} views to fuse without any surface, expected depth on the object", views.size());
  Extent extent;
  for (int k = 0; k < 3; ++k) {
    const auto [low, high] = range_along(points, Eigen::Vector3d::Unit(k));
    extent.low[k] = low;
    extent.high[k] = high;
  }
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const DepthView& view : views) {
    mean += view.T_camera_object.inverse().translation().normalized() / static_cast<double>(views.size());
  }
  if (mean.norm() < kOneSided) return extent;
  extent.stands = true;
  extent.up = mean.normalized();
  const auto [base, top] = range_along(points, extent.up);
  extent.base = base;
  extent.top = top;
  return extent;
}

TsdfVolume make_grid(const Extent& extent, const TsdfSettings& settings) {
  TsdfVolume grid;
  grid.voxel = settings.voxel;
  const double margin = (settings.truncation_voxels + 2.0) * settings.voxel;
  grid.origin = extent.low - Eigen::Vector3d::Constant(margin);
  const Eigen::Vector3d size = (extent.high - extent.low + Eigen::Vector3d::Constant(2.0 * margin)) / settings.voxel;
  const double voxels = (size.x() + 2.0) * (size.y() + 2.0) * (size.z() + 2.0);
  require(voxels < static_cast<double>(settings.max_voxels),
          "object of {:.3f} x {:.3f} x {:.3f} m in voxels of {} m, expected fewer than {} voxels",
          extent.high.x() - extent.low.x(), extent.high.y() - extent.low.y(), extent.high.z() - extent.low.z(),
          settings.voxel, settings.max_voxels);
  grid.nx = static_cast<int>(size.x()) + 2;
  grid.ny = static_cast<int>(size.y()) + 2;
  grid.nz = static_cast<int>(size.z()) + 2;
  grid.distance.assign(static_cast<std::size_t>(grid.nx) * grid.ny * grid.nz, 0.0F);
  grid.weight.assign(grid.distance.size(), 0.0F);
  return grid;
}

/// Gives the signed distance of one point in one view, in truncation distances, and its weight (0: unobserved).
struct Observation {
  float distance = 0.0F;
  float weight = 0.0F;
};

Observation observe(const DepthView& view, const Eigen::Vector3d& p_camera, double truncation,
                    const TsdfSettings& settings) {
  const auto px = view.pixel_of(p_camera);
  if (!px && !view.is_in_image(p_camera)) return {};
  if (!px || view.free_space_mask.at<std::uint8_t>(*px) != 0)
    return {1.0F, static_cast<float>(settings.outline_weight)};
  const double depth = view.depth.at<float>(*px);
  if (!std::isfinite(depth)) return {};
  // The distance is measured from where the voxel's own ray meets the pixel's tangent plane, so that distances at
  // grazing angles are not too long.
  const double facing_times_range = -view.normal(*px).dot(p_camera);
  const double distance = (depth / p_camera.z() - 1.0) * facing_times_range / truncation;
  if (distance < -1.0) return {};
  const double facing = facing_times_range / p_camera.norm();
  return {static_cast<float>(std::min(distance, 1.0)), static_cast<float>(facing * std::min(1.0, 1.0 + distance))};
}

void fill_slice(const std::vector<DepthView>& views, const TsdfSettings& settings, int k, TsdfVolume& grid) {
  const double truncation = settings.truncation_voxels * settings.voxel;
  for (const DepthView& view : views) {
    for (int j = 0; j < grid.ny; ++j) {
      for (int i = 0; i < grid.nx; ++i) {
        const Observation observation =
            observe(view, view.T_camera_object * grid.centre(i, j, k), truncation, settings);
        const std::size_t at = grid.index(i, j, k);
        grid.distance[at] += observation.weight * observation.distance;
        grid.weight[at] += observation.weight;
      }
    }
  }
}

/// Sums become means. The unseen becomes inside, but not below the lowest and above the highest that was seen: an
/// object stands on its base, and views from low down leave the space above it unseen.
void finish_slice(const Extent& extent, const TsdfSettings& settings, double min_count, int k, TsdfVolume& grid) {
  const double truncation = settings.truncation_voxels * settings.voxel;
  for (int j = 0; j < grid.ny; ++j) {
    for (int i = 0; i < grid.nx; ++i) {
      const std::size_t at = grid.index(i, j, k);
      float& distance = grid.distance[at];
      const bool seen = grid.weight[at] >= min_count;
      distance = seen ? distance / grid.weight[at] : -1.0F;
      if (!seen) grid.weight[at] = 0.0F;
      if (!extent.stands) continue;
      const double height = extent.up.dot(grid.centre(i, j, k));
      distance = std::max(distance, static_cast<float>(std::min((extent.base - height) / truncation, 1.0)));
      if (!seen) distance = std::max(distance, static_cast<float>(std::min((height - extent.top) / truncation, 1.0)));
    }
  }
}

TsdfVolume fuse_extent(const std::vector<DepthView>& views, const Extent& extent, const TsdfSettings& settings) {
  require(settings.voxel > 0.0, "voxels of {} m, expected more than 0", settings.voxel);
  TsdfVolume grid = make_grid(extent, settings);
  const double min_count = std::max(1.0, settings.min_fraction * static_cast<double>(views.size()));
  parallel_for(settings.threads, grid.nz, [&](int k) {
    fill_slice(views, settings, k, grid);
    finish_slice(extent, settings, min_count, k, grid);
  });
  return grid;
}

}  // namespace

TsdfVolume integrate_views(const std::vector<DepthView>& views, const TsdfSettings& settings) {
  return fuse_extent(views, find_extent(views), settings);
}

TsdfVolume integrate_box(const std::vector<DepthView>& views, const Eigen::AlignedBox3d& box,
                         const TsdfSettings& settings) {
  Extent extent;
  extent.low = box.min();
  extent.high = box.max();
  return fuse_extent(views, extent, settings);
}

}  // namespace houghstream::fusion
