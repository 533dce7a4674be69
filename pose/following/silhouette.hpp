#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "pose/model/object_model.hpp"

namespace houghstream {

/// A point of a model's surface that the camera sees at the edge of the model.
struct SilhouettePoint {
  Eigen::Vector3f point = Eigen::Vector3f::Zero();  ///< object frame, metres
  /// Unit vector, object frame; projected, it leads out of the model.
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  float inside_m = 0.0F;   ///< distance along the inverse normal that shows the model alone, metres
  float outside_m = 0.0F;  ///< distance along the normal that shows nothing of the model, metres
  float nearer_m = 0.0F;   ///< distance by which the model beside the point is nearer to the camera than it, metres
};

/// The model's silhouette from a camera's place, on which alone its points depend. A sparse viewpoint of Stoiber et al.
/// (2022, "Iterative Corresponding Geometry"), made when it is needed.
struct Silhouette {
  /// Place of the camera relative to the model's centre, object frame, metres.
  Eigen::Vector3f eye = Eigen::Vector3f::Zero();
  /// Points at even distances along the outline; none where the camera is too near.
  std::vector<SilhouettePoint> points;
};

/// Renders the model as the camera of this pose sees it, in an image of its own that is fine enough for any distance.
Silhouette make_silhouette(const ObjectModel& model, const Eigen::Isometry3d& T_camera_object, int points);

/// Returns whether the camera of this pose is still about where the silhouette was made from: within some three degrees
/// and a tenth of the distance.
bool is_silhouette_of(const Silhouette& silhouette, const ObjectModel& model, const Eigen::Isometry3d& T_camera_object);

}  // namespace houghstream
