#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "pipeline/base/settings_fields.hpp"
#include "pose/tracks/track.hpp"

namespace houghstream::tracks {

/// Which measured pose is of which object.
struct AssociationSettings {
  double reach_m = 0.06;         ///< of what stands
  double moving_reach_m = 0.12;  ///< of what moves
  double turn_cost = 0.5;        ///< of half a turn beside that of the whole reach
  double crowded = 0.6;          ///< radii within which no second object of a class can be
};

template <typename Visit>
void fields(const AssociationSettings& /*settings*/, const Visit& visit) {
  using S = AssociationSettings;
  visit(number("reach_m", &S::reach_m, 0, 10, "m"));
  visit(number("moving_reach_m", &S::moving_reach_m, 0, 10, "m"));
  visit(number("turn_cost", &S::turn_cost, 0, 100));
  visit(number("crowded", &S::crowded, 0, 10));
}

/// The objects of a class that are there, and the poses that a frame has of it.
struct ClassGroup {
  const Symmetries& symmetries;
  std::vector<Track*> objects = {};
  std::vector<const PoseObservation*> measured = {};
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< object frame, metres
  double radius_m = 0.0;
};

/// In their orders. Points into the tracks, the poses and the models.
ClassGroup group_by_class(const std::string& class_name, const std::vector<PoseObservation>& poses,
                          const TrackModels& models, std::vector<Track>& tracks);

/// For each object which measured pose is its, -1 for none: they are near each other and turned alike, and what is
/// confirmed comes before a candidate.
std::vector<int> assign_poses(const ClassGroup& one, const AssociationSettings& how);

/// Whether an object stands so near to a measured pose that it leaves no room for a second one.
bool is_space_occupied(const PoseMeasurement& measured, const ClassGroup& one, const AssociationSettings& how);

}  // namespace houghstream::tracks
