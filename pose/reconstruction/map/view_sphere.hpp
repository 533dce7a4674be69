#pragma once

#include <Eigen/Core>
#include <array>
#include <string>

namespace houghstream::reconstruction {

constexpr int kSphereDirections = 60;

/// Directions of the viewing sphere that are covered.
using ViewCoverage = std::array<bool, kSphereDirections>;

/// Returns evenly spread unit vectors in the object frame (z up), from the top down: a Fibonacci lattice (Gonzalez
/// 2010).
const std::array<Eigen::Vector3d, kSphereDirections>& view_directions();

/// Marks the sides of the object that a camera in this direction (object frame, from the object's middle) sees within
/// 50 degrees.
void mark_covered(const Eigen::Vector3d& towards_camera, ViewCoverage& coverage);

int count_covered(const ViewCoverage& coverage);

/// Returns a text such as "seen from 40 of 60 directions; from behind and from low nothing yet". The front is where the
/// camera began, `front` in the object frame.
std::string describe_coverage(const ViewCoverage& coverage, const Eigen::Vector3d& front);

}  // namespace houghstream::reconstruction
