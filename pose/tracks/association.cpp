#include "pose/tracks/association.hpp"

#include <algorithm>
#include <cmath>

#include "pose/motion/assignment.hpp"

namespace houghstream::tracks {

ClassGroup group_by_class(const std::string& class_name, const std::vector<PoseObservation>& poses,
                          const TrackModels& models, std::vector<Track>& tracks) {
  ClassGroup one{symmetries_of(models, class_name)};
  one.centre = centre_of(models, class_name);
  one.radius_m = radius_of(models, class_name);
  for (Track& track : tracks) {
    if (track.there() && track.class_name == class_name) one.objects.push_back(&track);
  }
  for (const PoseObservation& pose : poses) {
    if (pose.class_name == class_name) one.measured.push_back(&pose);
  }
  return one;
}

std::vector<int> assign_poses(const ClassGroup& one, const AssociationSettings& how) {
  constexpr double kUnconfirmed = 0.3;  // rather one that is known
  Eigen::MatrixXd costs(one.objects.size(), one.measured.size());
  for (std::size_t i = 0; i < one.objects.size(); ++i) {
    const Track& track = *one.objects[i];
    const double reach = track.pose.filter().moving() ? how.moving_reach_m : how.reach_m;
    for (std::size_t j = 0; j < one.measured.size(); ++j) {
      const double distance = track.pose.distance(one.measured[j]->measured, one.symmetries, one.centre);
      const double angle = track.pose.angle(one.measured[j]->measured, one.symmetries);
      costs(i, j) = distance > reach
                        ? 10.0
                        : distance / reach + how.turn_cost * angle / M_PI + (track.id == 0 ? kUnconfirmed : 0.0);
    }
  }
  constexpr double kLimit = 2.0;
  return solve_assignment(costs, kLimit);
}

bool is_space_occupied(const PoseMeasurement& measured, const ClassGroup& one, const AssociationSettings& how) {
  return std::any_of(one.objects.begin(), one.objects.end(), [&](const Track* track) {
    return track->pose.distance(measured, one.symmetries, one.centre) < how.crowded * one.radius_m;
  });
}

}  // namespace houghstream::tracks
