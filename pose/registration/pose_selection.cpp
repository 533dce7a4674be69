#include "pose/registration/pose_selection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "pipeline/base/logit.hpp"
#include "pose/model/angles.hpp"
#include "pose/registration/rotation_search.hpp"
#include "pose/seen/handle_observation.hpp"

namespace houghstream {
namespace {

struct ScoredResult {
  RegistrationResult result;
  float score = 0.0F;
};

/// The steps of the choice for one object, with what they share.
class PoseSelector {
 public:
  PoseSelector(const ObjectObservation& observation, const std::vector<RotationCandidate>& votes,
               const PoseSelectionSettings& settings)
      : observation_(observation),
        votes_(votes),
        settings_(settings),
        tolerance_{settings.tolerance_m, observation.noise} {}

  RegistrationResult best_of(const std::vector<RegistrationResult>& registered) const {
    RegistrationResult best;
    float best_score = -std::numeric_limits<float>::infinity();
    for (const RegistrationResult& result : registered) keep_better(result, best, best_score);
    return best;
  }

  /// Returns the best of `result` and of the best turns of it, registered again.
  RegistrationResult best_rotation(const RegistrationResult& result, double step_deg, double reach_deg,
                                   std::size_t maximum) const {
    RegistrationResult best = result;
    float best_score = score_of(result);
    const RotationRange range{step_deg * kRadPerDeg, reach_deg * kRadPerDeg, maximum, settings_.rotation_search.points};
    for (const ScoredPose& rotated : best_rotations_about_z(observation_, result.T_camera_object, range, tolerance_)) {
      RegistrationResult registered =
          climb_hill(register_rotated(observation_, rotated.T_camera_object, settings_.registration));
      registered.iterations += result.iterations;
      keep_better(registered, best, best_score);
    }
    return best;
  }

  /// Returns `result`, or it turned about the axis of a nearly round shape to where its handle is observed.
  RegistrationResult turn_to_handle(const RegistrationResult& result) const {
    if (observation_.model.unround_points.empty()) return result;
    const HandleObserver handle(observation_, result.T_camera_object, tolerance_);
    const std::optional<Eigen::Isometry3d> turned = handle.find_turn();
    if (!turned) return result;
    RegistrationResult registered = register_rotated(observation_, *turned, settings_.registration);
    registered = register_finely(observation_, registered, settings_.registration);
    registered.iterations += result.iterations;
    const bool is_better =
        is_near_detection(observation_, registered, settings_.registration) &&
        handle.observe_at(registered.T_camera_object).support() > handle.observe_at(result.T_camera_object).support();
    return is_better ? registered : result;
  }

  /// Returns `result`, and it turned by half a turn about each principal axis, registered again: a box looks the same
  /// to depth then, and only its texture differs. The best comes first, and none that ends elsewhere.
  std::vector<ScoredResult> find_flips(const RegistrationResult& result) const {
    std::vector<ScoredResult> flips = {{result, score_of(result)}};
    const Eigen::Vector3d middle = observation_.model.surface_median.cast<double>();
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::AngleAxisd half_turn(M_PI, observation_.model.axes.col(axis).cast<double>());
      const Eigen::Isometry3d flipped =
          result.T_camera_object * Eigen::Translation3d(middle) * half_turn * Eigen::Translation3d(-middle);
      RegistrationResult registered = climb_hill(register_rotated(observation_, flipped, settings_.registration));
      registered.iterations += result.iterations;
      if (is_near_detection(observation_, registered, settings_.registration))
        flips.push_back({registered, score_of(registered)});
    }
    std::stable_sort(flips.begin(), flips.end(),
                     [](const ScoredResult& a, const ScoredResult& b) { return a.score > b.score; });
    return flips;
  }

 private:
  void keep_better(const RegistrationResult& result, RegistrationResult& best, float& best_score) const {
    if (!is_near_detection(observation_, result, settings_.registration)) return;
    const float score = score_of(result);
    if (!(score > best_score)) return;
    best = result;
    best_score = score;
  }

  RegistrationResult climb_hill(RegistrationResult result) const {
    const RotationSearchSettings& search = settings_.rotation_search;
    const HillClimb hill_climb{search.fine_step_deg * kRadPerDeg, search.hill_climb_step_m, search.hill_climb_rounds,
                               search.points};
    result.T_camera_object =
        hill_climb_pose(observation_, result.T_camera_object, hill_climb, tolerance_).T_camera_object;
    return result;
  }

  /// Returns the joint score of a result by depth, colour and votes.
  float score_of(const RegistrationResult& result) const {
    const ScoredPose scored =
        score_pose_jointly(observation_, result.T_camera_object, settings_.registration.fine_points, tolerance_);
    const float support = vote_support(votes_, result.T_camera_object, settings_.initial);
    return scored.score * (1.0F + settings_.initial.vote_gain * support);
  }

  const ObjectObservation& observation_;
  const std::vector<RotationCandidate>& votes_;
  const PoseSelectionSettings& settings_;
  DepthTolerance tolerance_;
};

}  // namespace

RegistrationResult best_registered(const ObjectObservation& observation,
                                   const std::vector<RegistrationResult>& registered,
                                   const std::vector<RotationCandidate>& votes, const PoseSelectionSettings& settings) {
  const RegistrationResult best = PoseSelector(observation, votes, settings).best_of(registered);
  return best.inliers == 0 ? best : register_finely(observation, best, settings.registration);
}

double publication_probability(const ObjectObservation& observation, const RegistrationResult& best,
                               float detection_score, const PoseSelectionSettings& settings) {
  constexpr float kMinScore = 0.01F;  // whose logarithm means something
  const DepthTolerance tolerance{settings.tolerance_m, observation.noise};
  const float joint =
      score_pose_jointly(observation, best.T_camera_object, settings.registration.fine_points, tolerance).score;
  return logistic(0.91 + 1.72 * std::log(std::max(joint, kMinScore)) + 1.18 * logit(detection_score));
}

std::vector<RegistrationResult> select_poses(const ObjectObservation& observation, const RegistrationResult& best,
                                             const std::vector<RotationCandidate>& votes,
                                             const PoseSelectionSettings& settings) {
  const PoseSelector selector(observation, votes, settings);
  const RotationSearchSettings& search = settings.rotation_search;
  const RegistrationSettings& registration = settings.registration;
  const std::vector<ScoredResult> flips = selector.find_flips(best);
  const RegistrationResult rotated =
      selector.best_rotation(flips.front().result, search.step_deg, 180.0, search.registered);
  std::vector<RegistrationResult> fine = {register_finely(observation, rotated, registration)};
  for (std::size_t i = 1; i < flips.size() && fine.size() <= search.alternatives; ++i) {
    if (flips[i].score < search.min_alternative_ratio * flips.front().score) break;
    fine.push_back(register_finely(observation, flips[i].result, registration));
  }
  for (RegistrationResult& result : fine)
    result = refine_rotation(observation, selector.turn_to_handle(result), votes, settings);
  return fine;
}

RegistrationResult refine_rotation(const ObjectObservation& observation, const RegistrationResult& registered,
                                   const std::vector<RotationCandidate>& votes, const PoseSelectionSettings& settings) {
  const RotationSearchSettings& search = settings.rotation_search;
  const PoseSelector selector(observation, votes, settings);
  return register_finely(observation, selector.best_rotation(registered, search.fine_step_deg, search.step_deg, 1),
                         settings.registration);
}

RegistrationResult refine_pose(const ObjectObservation& observation, const Eigen::Isometry3d& T_camera_object,
                               const std::vector<RotationCandidate>& votes, const PoseSelectionSettings& settings) {
  RegistrationResult start;
  start.T_camera_object = T_camera_object;
  return refine_rotation(observation, register_finely(observation, start, settings.registration), votes, settings);
}

}  // namespace houghstream
