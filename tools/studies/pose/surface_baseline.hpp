#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <map>
#include <string>
#include <vector>

#include "pipeline/types/frame.hpp"
#include "pose/model/object_model.hpp"
#include "pose/seen/region.hpp"
#include "tools/studies/pose/pose_baselines.hpp"

namespace houghstream {

/// Points with unit normals, metres.
using SurfaceCloud = pcl::PointCloud<pcl::PointNormal>;

/// Returns one point for each cube of this side and each of six directions that its surface can face (the two sides of
/// a thin wall stay apart): the mean, in an order that depends on the points alone.
SurfaceCloud::Ptr thinned(const SurfaceCloud& cloud, double spacing_m);

/// Returns a view's points, object frame.
SurfaceCloud view_surface(const ModelView& view);

/// Points of a model that are visible from somewhere, object frame, thinned; normals outwards.
SurfaceCloud::Ptr model_surface(const ObjectModel& model, double spacing_m);

/// Returns the measured points of a region, camera frame, thinned; normals towards the camera. Points without a normal
/// (fewer than three neighbours) are left out.
SurfaceCloud::Ptr measured_surface(const RgbdFrame& frame, const DepthRegion& region, const SurfaceSettings& settings);

/// Holds the observation of a detection, as the baselines receive it.
struct SeenSurface {
  const RgbdFrame& frame;
  const ObjectModel& model;
  const DepthRegion& region;
  SurfaceCloud::Ptr cloud = nullptr;                        ///< measured_surface()
  Eigen::Vector3d centre_camera = Eigen::Vector3d::Zero();  ///< centre of the detection, metres
  double max_shift_m = 0.0;  ///< a pose whose vote centre is farther from it will not be taken

  bool reaches(const Eigen::Isometry3d& T_camera_object) const {
    return (T_camera_object * model.vote_centre.cast<double>() - centre_camera).norm() <= max_shift_m;
  }
};

/// Implements the common part of the baselines: the region, and the selection among their poses.
class SurfaceRival : public BaselineEstimator {
 public:
  SurfaceRival(const std::map<std::string, Mesh>& models, const PoseSettings& pose, const SurfaceSettings& surface);

  std::optional<Eigen::Isometry3d> estimate(const RgbdFrame& frame, const Detection& detection) const final;

 protected:
  const std::map<std::string, ObjectModel>& models() const { return models_; }
  const PoseSettings& pose_settings() const { return pose_; }

 private:
  /// Returns refined poses, camera from object; empty where none was found.
  virtual std::vector<Eigen::Isometry3d> propose(const std::string& name, const SeenSurface& surface) const = 0;

  std::map<std::string, ObjectModel> models_;
  PoseSettings pose_;
  SurfaceSettings surface_;
};

}  // namespace houghstream
