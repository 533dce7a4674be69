#include "pose/registration/refinement.hpp"

#include <algorithm>
#include <limits>

#include "pose/registration/turn_search.hpp"

namespace houghstream {
namespace {

/// The steps of refining one detection, with what they share.
class Refinement {
 public:
  Refinement(const SeenRegion& seen, const ObjectModel& model, const Eigen::Vector3f& centre_camera,
             const std::vector<RotationCandidate>& votes, const PoseSettings& settings)
      : seen_(seen),
        votes_(votes),
        model_(model),
        centre_(centre_camera.cast<double>()),
        settings_(settings),
        tolerance_{settings.verification.tolerance_m, settings.noise},
        end_m_(DepthTolerance{settings.registration.end_distance_m, settings.noise}.at(centre_camera.z())),
        start_m_(std::max(end_m_, settings.registration.start_distance_m)) {}

  RegistrationResult best_of(const std::vector<PoseCandidate>& candidates) const {
    RegistrationResult best;
    float best_score = -std::numeric_limits<float>::infinity();
    for (const PoseCandidate& candidate : candidates) {
      const RegistrationResult coarse = coarsely(candidate.T_camera_object, start_m_);
      const float score = believe(coarse);
      if (!is_near(coarse) || !(score > best_score)) continue;
      best = coarse;
      best_score = score;
    }
    return best;
  }

  /// The best of `result` and of the best turns of it, registered again.
  RegistrationResult turned(const RegistrationResult& result, double step_deg, double reach_deg,
                            std::size_t most) const {
    RegistrationResult best = result;
    float best_score = believe(result);
    const TurnRange range{step_deg * kRadPerDeg, reach_deg * kRadPerDeg, most, settings_.turn.points};
    for (const ScoredPose& turn :
         best_turns(seen_.frame, seen_.colours, model_, result.T_camera_object, range, tolerance_)) {
      RegistrationResult again = uphill(coarsely(turn.T_camera_object, 0.5 * (start_m_ + end_m_)));
      again.iterations += result.iterations;
      const float score = believe(again);
      if (!is_near(again) || !(score > best_score)) continue;
      best = again;
      best_score = score;
    }
    return best;
  }

  RegistrationResult finely(const RegistrationResult& result) const {
    const RegistrationSettings& registration = settings_.registration;
    RegistrationResult fine =
        registered(result.T_camera_object, {registration.fine_iterations, registration.fine_points, end_m_, end_m_, 1});
    fine.iterations += result.iterations;
    return is_near(fine) ? fine : result;
  }

 private:
  RegistrationResult uphill(RegistrationResult result) const {
    const TurnSettings& turn = settings_.turn;
    const Climb climb{turn.fine_step_deg * kRadPerDeg, turn.climb_step_m, turn.climb_rounds, turn.points};
    result.T_camera_object =
        climb_pose(seen_.frame, seen_.colours, model_, result.T_camera_object, climb, tolerance_).T_camera_object;
    return result;
  }

  /// How depth, colour and votes speak for the result.
  float believe(const RegistrationResult& result) const {
    const ScoredPose judged = judge_pose(seen_.frame, seen_.colours, model_, result.T_camera_object,
                                         settings_.registration.fine_points, tolerance_);
    const float support = vote_support(votes_, result.T_camera_object, settings_.initial);
    return judged.score * (1.0F + settings_.initial.vote_gain * support);
  }

  RegistrationResult coarsely(const Eigen::Isometry3d& T_camera_object, double start_m) const {
    const RegistrationSettings& registration = settings_.registration;
    return registered(T_camera_object, {registration.coarse_iterations, registration.coarse_points, start_m, end_m_});
  }

  RegistrationResult registered(const Eigen::Isometry3d& T_camera_object, const RegistrationStage& stage) const {
    if (settings_.registration.method == Registration::kProjective) {
      return register_projective(seen_.frame, model_, T_camera_object, stage, settings_.registration);
    }
    return register_pcl(region_points(seen_.frame, seen_.region, stage.points), model_, T_camera_object, stage,
                        settings_.registration);
  }

  bool is_near(const RegistrationResult& result) const {
    return (result.T_camera_object.translation() - centre_).norm() <= settings_.registration.max_shift_m;
  }

  const SeenRegion& seen_;
  const std::vector<RotationCandidate>& votes_;
  const ObjectModel& model_;
  Eigen::Vector3d centre_;
  const PoseSettings& settings_;
  DepthTolerance tolerance_;
  double end_m_;
  double start_m_;
};

}  // namespace

RegistrationResult refine_candidates(const SeenRegion& seen, const ObjectModel& model,
                                     const Eigen::Vector3f& centre_camera, const std::vector<PoseCandidate>& candidates,
                                     const std::vector<RotationCandidate>& votes, const PoseSettings& settings) {
  const Refinement refinement(seen, model, centre_camera, votes, settings);
  RegistrationResult best = refinement.best_of(candidates);
  if (best.inliers == 0) return best;
  const TurnSettings& turn = settings.turn;
  const RegistrationResult settled = refinement.finely(best);
  const RegistrationResult fine = refinement.finely(refinement.turned(settled, turn.step_deg, 180.0, turn.registered));
  return refinement.finely(refinement.turned(fine, turn.fine_step_deg, turn.step_deg, 1));
}

}  // namespace houghstream
