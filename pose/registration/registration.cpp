#include "pose/registration/registration.hpp"

#include <algorithm>

namespace houghstream {

CorrespondenceDistances correspondence_distances(const ObjectObservation& observation,
                                                 const RegistrationSettings& settings) {
  const double end =
      DepthTolerance{settings.max_correspondence_end_m, observation.noise}.at(observation.centre_camera.z());
  return {std::max(end, settings.max_correspondence_start_m), end};
}

RegistrationResult register_coarsely(const ObjectObservation& observation, const Eigen::Isometry3d& T_camera_object,
                                     double start_m, const RegistrationSettings& settings) {
  RegistrationStage stage;
  stage.iterations = settings.coarse_iterations;
  stage.points = settings.coarse_points;
  stage.max_correspondence_start_m = start_m;
  stage.max_correspondence_end_m = correspondence_distances(observation, settings).end;
  return settings.engine(observation, T_camera_object, stage, settings);
}

RegistrationResult register_rotated(const ObjectObservation& observation, const Eigen::Isometry3d& T_camera_object,
                                    const RegistrationSettings& settings) {
  const CorrespondenceDistances distances = correspondence_distances(observation, settings);
  return register_coarsely(observation, T_camera_object, 0.5 * (distances.start + distances.end), settings);
}

RegistrationResult register_finely(const ObjectObservation& observation, const RegistrationResult& result,
                                   const RegistrationSettings& settings) {
  const double end_m = correspondence_distances(observation, settings).end;
  RegistrationStage stage;
  stage.iterations = settings.fine_iterations;
  stage.points = settings.fine_points;
  stage.max_correspondence_start_m = end_m;
  stage.max_correspondence_end_m = end_m;
  stage.search_steps = 1;
  RegistrationResult fine = settings.engine(observation, result.T_camera_object, stage, settings);
  fine.iterations += result.iterations;
  return is_near_detection(observation, fine, settings) ? fine : result;
}

bool is_near_detection(const ObjectObservation& observation, const RegistrationResult& result,
                       const RegistrationSettings& settings) {
  return distance_from_detected(observation, result.T_camera_object) <= settings.max_shift_m;
}

std::vector<RegistrationResult> register_candidates(const ObjectObservation& observation,
                                                    const std::vector<PoseCandidate>& candidates,
                                                    const RegistrationSettings& settings) {
  const double start_m = correspondence_distances(observation, settings).start;
  std::vector<RegistrationResult> registered;
  registered.reserve(candidates.size());
  for (const PoseCandidate& candidate : candidates) {
    registered.push_back(register_coarsely(observation, candidate.T_camera_object, start_m, settings));
  }
  return registered;
}

}  // namespace houghstream
