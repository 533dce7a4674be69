#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include "pipeline/types/frame.hpp"
#include "pose/model/object_model.hpp"
#include "pose/seen/region.hpp"
#include "tools/studies/pose/rival_settings.hpp"

namespace houghstream {

/// Points with unit normals, metres.
using SurfaceCloud = pcl::PointCloud<pcl::PointNormal>;

/// One point for each cube of this side and each of six directions that its surface can face (the two sides of a thin
/// wall stay apart): the mean, in an order that depends on the points alone.
SurfaceCloud::Ptr thinned(const SurfaceCloud& cloud, double spacing_m);

/// A view's points, object frame.
SurfaceCloud view_surface(const ModelView& view);

/// What of a model can be seen from somewhere, object frame, thinned; normals outwards.
SurfaceCloud::Ptr model_surface(const ObjectModel& model, double spacing_m);

/// The measured points of a region, camera frame, thinned; normals towards the camera. Points without a normal (fewer
/// than three neighbours) are left out.
SurfaceCloud::Ptr measured_surface(const RgbdFrame& frame, const DepthRegion& region, const SurfaceSettings& settings);

}  // namespace houghstream
