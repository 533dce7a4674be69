#pragma once

#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/base/settings_fields.hpp"
#include "pipeline/geometry/mesh.hpp"
#include "pipeline/geometry/symmetry.hpp"
#include "pose/model/surface_colour.hpp"
#include "pose/model/surface_texture.hpp"

namespace houghstream {

/// Settings of an object model: the view directions spread over the sphere, and the visible points of each.
struct ModelSettings {
  int views_per_edge = 4;        ///< each edge of an icosahedron in so many parts: 10 n^2 + 2 directions
  int points_per_view = 600;     ///< maximum number of points
  double view_distance_m = 1.2;  ///< camera's distance from the model's centre
  int pixels_per_diameter = 72;  ///< resolution of the images from which visible points are drawn
  double min_facing = 0.15;      ///< cosine between normal and line of sight below which a point is too grazing
  std::map<std::string, Eigen::Vector3f> vote_centres;  ///< ObjectModel::vote_centre by name; of others the origin
  /// Motions by class name after which the object looks as before, its texture too (models_info.json); classes without
  /// an entry have none. A symmetry that the texture contradicts is accepted as stated.
  std::map<std::string, Symmetries> symmetries;
  double right_within = 0.1;  ///< ObjectModel::alternatives are farther from the pose than this, diameters (MSSD)
  /// Symmetries by class name; for other classes the mesh is searched.
  std::map<std::string, ShapeSymmetry> shape_symmetries;
};

template <typename Visit>
void fields(const ModelSettings& /*settings*/, const Visit& visit) {
  using S = ModelSettings;
  visit(number("views_per_edge", &S::views_per_edge, 1, 32));
  visit(number("points_per_view", &S::points_per_view, 1, 100000));
  visit(number("view_distance_m", &S::view_distance_m, 0.01, 100, "m"));
  visit(number("pixels_per_diameter", &S::pixels_per_diameter, 8, 4096, "pixels"));
  visit(number("min_facing", &S::min_facing, 0, 1));
  visit(number("right_within", &S::right_within, 0, 1, "diameters"));
}

/// Surface points visible from one direction, in random order so that any first n of them cover the view evenly
/// (sparse viewpoint models: Stoiber et al. 2022, "Iterative Corresponding Geometry").
struct ModelView {
  Eigen::Vector3f direction = Eigen::Vector3f::Zero();  ///< unit, from the model's centre to the camera
  std::vector<Eigen::Vector3f> points;                  ///< object frame, metres
  std::vector<Eigen::Vector3f> normals;                 ///< unit length, towards the camera
  std::vector<LabColour> colours;                       ///< colours of the points; empty where the mesh has none
  float area = 0.0F;                                    ///< area of the silhouette, relative to the largest view's
};

/// A mesh with what registration needs of it.
struct ObjectModel {
  Mesh mesh;
  Eigen::Vector3f centre = Eigen::Vector3f::Zero();  ///< centre of the bounding box, object frame
  /// Point for which the detections' votes are cast, and where their centre lies: object frame, metres.
  Eigen::Vector3f vote_centre = Eigen::Vector3f::Zero();
  /// Median of the surface along each axis, object frame; a handle hardly changes it.
  Eigen::Vector3f surface_median = Eigen::Vector3f::Zero();
  Eigen::Matrix3f axes = Eigen::Matrix3f::Identity();  ///< columns: principal axes of the surface, object frame
  int thin_axis = 0;                                   ///< column of `axes` along which the mesh extends least
  float thickness = 0.0F;                              ///< its extent along that axis, metres
  float radius = 0.0F;          ///< radius of the sphere about the centre that holds the mesh, metres
  Symmetries shape_symmetries;  ///< rotations after which a depth camera measures the same, object frame
  /// Axis about which all but a part such as a handle measures the same, where no symmetry is continuous.
  std::optional<ContinuousSymmetry> nearly_round;
  std::vector<ModelView> views;
  SurfaceTexture texture;  ///< empty where the mesh has no colours
  /// Motions of the object frame, metres, after which the shape is as before and the pose is another one: only the
  /// texture distinguishes a pose from the poses after these. Rotations about a continuous symmetry are sampled.
  std::vector<Eigen::Isometry3d> alternatives;
  /// Motions after which the shape is nearly as before: depth and texture distinguish the poses after these, once
  /// registered.
  std::vector<Eigen::Isometry3d> near_alternatives;
  /// Rotations about `nearly_round`, which are alternatives where the part that breaks the round shape is occluded
  /// before and after; and points of that part, object frame, metres, with their outward normals.
  std::vector<Eigen::Isometry3d> partial_alternatives;
  std::vector<Eigen::Vector3f> unround_points;
  std::vector<Eigen::Vector3f> unround_normals;
  bool is_unround_alike = false;  ///< whether that part has the colours of the rest
};

/// Makes the model; the result is the same for any number of threads. Throws InputError naming `name` when the mesh has
/// no triangles, is degenerate to a point, or is visible from nowhere.
ObjectModel make_object_model(const std::string& name, Mesh mesh, const ModelSettings& settings, int threads = 1);

/// Returns the stored view nearest to the camera's view of the model.
const ModelView& nearest_view(const ObjectModel& model, const Eigen::Isometry3d& T_camera_object);

/// Returns the corners of the icosahedron whose edges are cut in `parts`, on the unit sphere, in a fixed order.
std::vector<Eigen::Vector3f> sphere_directions(int parts);

}  // namespace houghstream
