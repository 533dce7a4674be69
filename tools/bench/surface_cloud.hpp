#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include "pipeline/frame.hpp"
#include "pose/object_model.hpp"
#include "pose/region.hpp"
#include "tools/bench/rival_settings.hpp"

namespace houghstream {

/// Points with unit normals, metres.
using SurfaceCloud = pcl::PointCloud<pcl::PointNormal>;

/// What of a model can be seen from somewhere, object frame, thinned; normals outwards.
SurfaceCloud::Ptr model_surface(const ObjectModel& model, const SurfaceSettings& settings);

/// The measured points of a region, camera frame, thinned; normals towards the camera. Points without a normal (fewer
/// than three neighbours) are left out.
SurfaceCloud::Ptr measured_surface(const RgbdFrame& frame, const DepthRegion& region, const SurfaceSettings& settings);

}  // namespace houghstream
