#include "pose/registration/registration.hpp"

#include <algorithm>

namespace houghstream {

CorrespondenceDistances correspondence_distances(const ObjectObservation& seen, const RegistrationSettings& settings) {
  const double end = DepthTolerance{settings.max_correspondence_end_m, seen.noise}.at(seen.centre_camera.z());
  return {std::max(end, settings.max_correspondence_start_m), end};
}

RegistrationResult register_coarsely(const ObjectObservation& seen, const Eigen::Isometry3d& T_camera_object,
                                     double start_m, const RegistrationSettings& settings) {
  const RegistrationStage stage{settings.coarse_iterations, settings.coarse_points, start_m,
                                correspondence_distances(seen, settings).end};
  return settings.engine(seen, T_camera_object, stage, settings);
}

RegistrationResult register_finely(const ObjectObservation& seen, const RegistrationResult& result,
                                   const RegistrationSettings& settings) {
  constexpr int kSearchSteps = 1;
  const double end_m = correspondence_distances(seen, settings).end;
  const RegistrationStage stage{settings.fine_iterations, settings.fine_points, end_m, end_m, kSearchSteps};
  RegistrationResult fine = settings.engine(seen, result.T_camera_object, stage, settings);
  fine.iterations += result.iterations;
  return is_near_detection(seen, fine, settings) ? fine : result;
}

bool is_near_detection(const ObjectObservation& seen, const RegistrationResult& result,
                       const RegistrationSettings& settings) {
  return distance_from_detected(seen, result.T_camera_object) <= settings.max_shift_m;
}

std::vector<RegistrationResult> register_candidates(const ObjectObservation& seen,
                                                    const std::vector<PoseCandidate>& candidates,
                                                    const RegistrationSettings& settings) {
  const double start_m = correspondence_distances(seen, settings).start;
  std::vector<RegistrationResult> registered;
  registered.reserve(candidates.size());
  for (const PoseCandidate& candidate : candidates) {
    registered.push_back(register_coarsely(seen, candidate.T_camera_object, start_m, settings));
  }
  return registered;
}

}  // namespace houghstream
