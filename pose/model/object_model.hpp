#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "pipeline/geometry/mesh.hpp"
#include "pose/model/surface_colour.hpp"
#include "pose/pose_settings.hpp"

namespace houghstream {

/// Surface points visible from one direction, in random order so that any first n of them cover the view evenly
/// (sparse viewpoint models: Stoiber et al. 2022, "Iterative Corresponding Geometry").
struct ModelView {
  Eigen::Vector3f direction = Eigen::Vector3f::Zero();  ///< unit, from the model's centre to the camera
  std::vector<Eigen::Vector3f> points;                  ///< object frame, metres
  std::vector<Eigen::Vector3f> normals;                 ///< unit length, towards the camera
  std::vector<LabColour> colours;                       ///< of the points; empty where the mesh has none
  float area = 0.0F;                                    ///< of the silhouette, relative to the largest view's
};

/// A mesh with what registration needs of it.
struct ObjectModel {
  Mesh mesh;
  Eigen::Vector3f centre = Eigen::Vector3f::Zero();  ///< of the bounding box, object frame
  Eigen::Vector3f middle =
      Eigen::Vector3f::Zero();  ///< median of the surface along each axis: a handle does not move it
  float radius = 0.0F;          ///< of the sphere about the centre that holds the mesh, metres
  std::vector<ModelView> views;
};

/// Throws InputError naming `name` when the mesh has no triangles, is flat to a point, or shows nothing.
ObjectModel make_object_model(const std::string& name, Mesh mesh, const ModelSettings& settings);

/// The stored view nearest to how the camera sees the model.
const ModelView& nearest_view(const ObjectModel& model, const Eigen::Isometry3d& T_camera_object);

/// Corners of the icosahedron whose edges are cut in `parts`, on the unit sphere, in a fixed order.
std::vector<Eigen::Vector3f> sphere_directions(int parts);

}  // namespace houghstream
