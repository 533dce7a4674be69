#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "pipeline/base/settings_fields.hpp"
#include "pose/tracks/track.hpp"

namespace houghstream::tracks {

/// Settings of the assignment of measured poses to objects.
struct AssociationSettings {
  double reach_m = 0.06;         ///< gating distance, metres: up to it a pose may be of a static object
  double moving_reach_m = 0.12;  ///< gating distance of a moving object, metres
  double rotation_cost = 0.5;    ///< cost of a rotation by half a turn; that of the whole reach is 1
  double exclusion_ratio = 0.6;  ///< radii within which there is no second object of a class
};

template <typename Visit>
void fields(const AssociationSettings& /*settings*/, const Visit& visit) {
  using S = AssociationSettings;
  visit(number("reach_m", &S::reach_m, 0, 10, "m"));
  visit(number("moving_reach_m", &S::moving_reach_m, 0, 10, "m"));
  visit(number("rotation_cost", &S::rotation_cost, 0, 100));
  visit(number("exclusion_ratio", &S::exclusion_ratio, 0, 10));
}

/// The present objects of a class, and the poses that a frame has of it.
struct ClassGroup {
  const Symmetries& symmetries;
  std::vector<Track*> objects = {};
  std::vector<const PoseObservation*> measured = {};
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< object frame, metres
  double radius_m = 0.0;
};

/// Collects the present objects and the poses of a class, in their orders. The group points into the tracks, the poses
/// and the models.
ClassGroup group_by_class(const std::string& class_name, const std::vector<PoseObservation>& poses,
                          const TrackModels& models, std::vector<Track>& tracks);

/// Returns for each object the index of its measured pose, -1 for none: the assignment of least cost (distance and
/// rotation), in which confirmed objects come before candidates.
std::vector<int> assign_poses(const ClassGroup& group, const AssociationSettings& settings);

/// Returns whether an object is so near to a measured pose that there is no space for a second one.
bool is_space_occupied(const PoseMeasurement& measured, const ClassGroup& group, const AssociationSettings& settings);

}  // namespace houghstream::tracks
