#pragma once

#include <vector>

#include "pipeline/geometry/mesh.hpp"
#include "pipeline/geometry/symmetry.hpp"

namespace houghstream {

/// Axes about which much of a surface is one of revolution, the best first, at most four; what a handle or a spout adds
/// does not move them. The normals of a surface of revolution meet its axis (Pottmann and Wallner 2001,
/// "Computational Line Geometry"; Gelfand and Guibas 2004 call such motions slippable): for a point p with normal n
/// and an axis a through o, n . (a x (p - o)) = 0. The sum over the surface is weighted by Geman and McClure's kernel
/// of width `sigma_m`, from every direction of a hemisphere. `offset` is the axis' point nearest to `centre`.
std::vector<ContinuousSymmetry> find_revolution_axes(const SurfacePoints& surface, const Eigen::Vector3d& centre,
                                                     double sigma_m);

/// Returns directions spread evenly over the half of the unit sphere with z >= 0 (a Fibonacci lattice).
std::vector<Eigen::Vector3d> hemisphere_directions(int count);

}  // namespace houghstream
