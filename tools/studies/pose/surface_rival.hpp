#pragma once

#include <map>
#include <string>
#include <vector>

#include "tools/studies/pose/pose_rivals.hpp"
#include "tools/studies/pose/surface_cloud.hpp"

namespace houghstream {

/// What is seen of a detection, as the rivals get it.
struct SeenSurface {
  const RgbdFrame& frame;
  const ObjectModel& model;
  const DepthRegion& region;
  SurfaceCloud::Ptr cloud = nullptr;                        ///< measured_surface()
  Eigen::Vector3d centre_camera = Eigen::Vector3d::Zero();  ///< of the detection, metres
  double max_shift_m = 0.0;  ///< a pose whose vote centre is farther from it will not be taken

  bool reaches(const Eigen::Isometry3d& T_camera_object) const {
    return (T_camera_object * model.vote_centre.cast<double>() - centre_camera).norm() <= max_shift_m;
  }
};

/// What the rivals have in common: the region that they look at, and the choice among their poses.
class SurfaceRival : public BaselineEstimator {
 public:
  SurfaceRival(const std::map<std::string, Mesh>& models, const PoseSettings& pose, const SurfaceSettings& surface);

  std::optional<Eigen::Isometry3d> estimate(const RgbdFrame& frame, const Detection& detection) const final;

 protected:
  const std::map<std::string, ObjectModel>& models() const { return models_; }
  const PoseSettings& pose_settings() const { return pose_; }

 private:
  /// Refined poses, camera from object; empty where none was found.
  virtual std::vector<Eigen::Isometry3d> propose(const std::string& name, const SeenSurface& seen) const = 0;

  std::map<std::string, ObjectModel> models_;
  PoseSettings pose_;
  SurfaceSettings surface_;
};

}  // namespace houghstream
