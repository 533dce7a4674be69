#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "pose/fusion/depth_view.hpp"

namespace houghstream::fusion {

/// Stores a box of voxels in the object frame. Voxel (i,j,k) has its centre at origin + voxel * (i,j,k).
struct TsdfVolume {
  int nx = 0, ny = 0, nz = 0;
  double voxel = 0.0;                                ///< edge length, metres
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< centre of voxel (0,0,0), metres
  std::vector<float> distance;  ///< distance to the surface in truncation distances, -1 (inside) to 1; x runs fastest
  std::vector<float> weight;    ///< weight of the observations; 0 = unobserved

  std::size_t index(int i, int j, int k) const {
    return (static_cast<std::size_t>(k) * ny + j) * static_cast<std::size_t>(nx) + i;
  }
  Eigen::Vector3d centre(int i, int j, int k) const { return origin + voxel * Eigen::Vector3d(i, j, k); }
};

/// Settings of a TSDF volume and of its integration.
struct TsdfSettings {
  double voxel = 0.0015;           ///< metres
  double truncation_voxels = 4.0;  ///< distances beyond are only "in front"
  double min_fraction = 0.05;      ///< fraction of the views: a voxel of less weight counts as unobserved
  double outline_weight = 0.5;     ///< weight of a view whose mask excludes the object there
  std::size_t max_voxels = 40'000'000;
  int threads = 1;  ///< any number gives the same result
};

/// Returns the weighted mean of the views' signed distances (Curless & Levoy 1996): along the surface's normal,
/// weighted by how frontally the surface is seen, less and less behind it (as Bylow et al. 2013: walls have another
/// side); rays beside the mask carve free space, beside the view's images too, unless they miss DepthView::image.
/// Unobserved voxels lie behind surfaces and count as inside, so that the solid is closed. Where all views look from
/// one side, unobserved voxels below the lowest observed surface, on which the object stands, and above the highest one
/// count as outside. Throws InputError without views or points, or where they need more than `max_voxels`.
TsdfVolume integrate_views(const std::vector<DepthView>& views, const TsdfSettings& settings);

/// Integrates the views in a box of the object frame, metres: voxels that no view has observed are inside, with weight
/// 0. Throws InputError where the box needs more than `max_voxels`.
TsdfVolume integrate_box(const std::vector<DepthView>& views, const Eigen::AlignedBox3d& box,
                         const TsdfSettings& settings);

}  // namespace houghstream::fusion
