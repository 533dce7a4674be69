#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "pose/model/object_model.hpp"

namespace houghstream {

/// A point of a model's surface that the camera sees at the edge of the model.
struct SilhouettePoint {
  Eigen::Vector3f point = Eigen::Vector3f::Zero();   ///< object frame, metres
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  ///< unit, object frame; projected, it leads out of the model
  float inside_m = 0.0F;   ///< along the inverse normal, over which all that is seen is the model, metres
  float outside_m = 0.0F;  ///< along the normal, over which nothing of the model is seen, metres
  float nearer_m = 0.0F;   ///< by which the model beside the point comes nearer to the camera than it, metres
};

/// The model's silhouette from where a camera is: which points it has depends on nothing else of the pose. A sparse
/// viewpoint of Stoiber et al. (2022, "Iterative Corresponding Geometry"), made when it is needed.
struct Silhouette {
  Eigen::Vector3f eye = Eigen::Vector3f::Zero();  ///< the camera, from the model's centre, object frame, metres
  std::vector<SilhouettePoint> points;            ///< evenly along the outline; empty where the camera is too near
};

/// Renders the model as the camera of this pose sees it, in an image of its own that is fine enough for any distance.
Silhouette make_silhouette(const ObjectModel& model, const Eigen::Isometry3d& T_camera_object, int points);

/// Whether the camera of this pose is still about where the silhouette was made from: within some three degrees and a
/// tenth of the distance.
bool is_silhouette_of(const Silhouette& silhouette, const ObjectModel& model, const Eigen::Isometry3d& T_camera_object);

}  // namespace houghstream
