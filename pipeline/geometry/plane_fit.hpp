#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "pipeline/base/random.hpp"
#include "pipeline/types/plane.hpp"

namespace houghstream {

/// Returns a value of a point: the distance from a plane within which it belongs to it, metres, or its weight.
using ValueOfPoint = std::function<double(const Eigen::Vector3d&)>;

/// Effort of find_largest_plane().
struct PlaneSearch {
  int trials = 40;
  int max_counted = 600;      ///< number of points by which a trial is judged, evenly taken
  double min_cross_m2 = 0.0;  ///< three points that span less, twice their triangle's area, define no plane
};

/// Returns the plane through three of the points that the most points belong to, by random trials (Fischler and Bolles
/// 1981, "Random Sample Consensus"); nothing where no three points define one. `points` holds at least one.
std::optional<Plane> find_largest_plane(const std::vector<Eigen::Vector3d>& points, const ValueOfPoint& limit_m,
                                        const PlaneSearch& search, Random& random);

/// Returns the points that belong to a plane.
std::vector<Eigen::Vector3d> points_on(const Plane& plane, const std::vector<Eigen::Vector3d>& points,
                                       const ValueOfPoint& limit_m);

/// Returns the plane through the weighted mean of the points across which they vary least; at least three points.
Plane fit_plane(const std::vector<Eigen::Vector3d>& points, const ValueOfPoint& weight);

}  // namespace houghstream
