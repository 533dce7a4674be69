#include "pose/tracks/association.hpp"

#include <algorithm>
#include <cmath>

#include "pose/motion/assignment.hpp"

namespace houghstream::tracks {

ClassGroup group_by_class(const std::string& class_name, const std::vector<PoseObservation>& poses,
                          const TrackModels& models, std::vector<Track>& tracks) {
  ClassGroup group{symmetries_of(models, class_name)};
  group.centre = centre_of(models, class_name);
  group.radius_m = radius_of(models, class_name);
  for (Track& track : tracks) {
    if (track.is_present() && track.class_name == class_name) group.objects.push_back(&track);
  }
  for (const PoseObservation& pose : poses) {
    if (pose.class_name == class_name) group.measured.push_back(&pose);
  }
  return group;
}

std::vector<int> assign_poses(const ClassGroup& group, const AssociationSettings& settings) {
  constexpr double kCandidateCost = 0.3;  // extra cost of an unconfirmed track, so that confirmed ones are preferred
  constexpr double kLimit = 2.0;
  constexpr double kOutOfReach = 10.0;  // above kLimit: never assigned
  Eigen::MatrixXd costs(group.objects.size(), group.measured.size());
  for (std::size_t i = 0; i < group.objects.size(); ++i) {
    const Track& track = *group.objects[i];
    const double reach = track.pose.filter().moving() ? settings.moving_reach_m : settings.reach_m;
    for (std::size_t j = 0; j < group.measured.size(); ++j) {
      const double distance = track.pose.distance(group.measured[j]->measured, group.symmetries, group.centre);
      const double angle = track.pose.angle(group.measured[j]->measured, group.symmetries);
      costs(i, j) = distance > reach ? kOutOfReach
                                     : distance / reach + settings.rotation_cost * angle / M_PI +
                                           (track.id == 0 ? kCandidateCost : 0.0);
    }
  }
  return solve_assignment(costs, kLimit);
}

bool is_space_occupied(const PoseMeasurement& measured, const ClassGroup& group, const AssociationSettings& settings) {
  return std::any_of(group.objects.begin(), group.objects.end(), [&](const Track* track) {
    return track->pose.distance(measured, group.symmetries, group.centre) < settings.exclusion_ratio * group.radius_m;
  });
}

}  // namespace houghstream::tracks
