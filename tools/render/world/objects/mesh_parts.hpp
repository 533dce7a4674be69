#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <vector>

#include "pipeline/geometry/mesh.hpp"

// These are the building blocks of all rendered assets. Every part is a closed surface with outward normals and its own
// texture; compose() joins parts into one mesh with one texture.

namespace houghstream::world {

/// Describes a point of the outline of a surface of revolution about z. Two equal consecutive points make a sharp edge.
struct ProfilePoint {
  double radius = 0.0;  ///< metres, 0 only at the ends
  double z = 0.0;       ///< metres
  double v = 0.0;       ///< texture row, 0 (top of the texture) to 1
};

/// Makes a surface of revolution about z. The profile goes from the axis at the bottom, round the outside, back to the
/// axis.
Mesh lathe(const std::vector<ProfilePoint>& profile, const cv::Mat& texture, int segments = 48);

/// Distributes texture rows v_start to v_end over the profile by arc length (fills ProfilePoint::v).
std::vector<ProfilePoint> with_arc_length(std::vector<ProfilePoint> profile, double v_start = 1.0, double v_end = 0.0);

/// Holds the textures of a box's faces. Front looks to -y, right to +x. An empty one takes the front's.
struct BoxFaces {
  cv::Mat front, back, left, right, top, bottom;
};

/// Makes an axis-aligned box centred on the origin; `size` in metres.
Mesh box(const Eigen::Vector3d& size, const BoxFaces& faces);
Mesh box(const Eigen::Vector3d& size, const cv::Mat& texture);

/// Makes a round rod along a path with closed ends (handles, legs, spouts).
Mesh tube(const std::vector<Eigen::Vector3d>& path, double radius, const cv::Mat& texture, int segments = 12);

/// Makes a tube with a radius for each point of the path, metres.
Mesh tapered_tube(const std::vector<Eigen::Vector3d>& path, const std::vector<double>& radii, const cv::Mat& texture,
                  int segments = 12);

/// Makes a straight solid along y, from -depth/2 to depth/2. `outline` holds (x, z), convex, counter-clockwise seen
/// from -y; `ends` covers its bounding rectangle, `side` each of the flat sides. Lengths are in metres.
Mesh prism(const std::vector<Eigen::Vector2d>& outline, double depth, const cv::Mat& ends, const cv::Mat& side);

/// Returns the mesh scaled about the origin along each axis.
Mesh scaled(Mesh mesh, const Eigen::Vector3d& factors);

/// A part and where it goes.
struct Part {
  Mesh mesh;
  Eigen::Isometry3d T_object_part = Eigen::Isometry3d::Identity();
};
Part at(Mesh mesh, const Eigen::Vector3d& translation, double yaw_rad = 0.0);

/// Composes one mesh with one texture atlas; textures shared between parts (same pixels in memory) are stored once.
Mesh compose(const std::vector<Part>& parts);

/// Moves the origin to the centre of the bounding box and colours the vertices from the texture.
Mesh finish_object(Mesh mesh);

}  // namespace houghstream::world
